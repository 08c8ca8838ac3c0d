// Copyright and licence: see package.xml.

/// \file
/// The reports of a gate on /diagnostics and in the log.

#ifndef DEROS_RUNTIME_CPP__GATE_REPORT_HPP_
#define DEROS_RUNTIME_CPP__GATE_REPORT_HPP_

#include <cstddef>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "deros_runtime_cpp/event_loop.hpp"
#include "deros_runtime_cpp/publishers.hpp"
#include "deros_runtime_cpp/target_publishers.hpp"
#include "diagnostic_msgs/msg/diagnostic_array.hpp"
#include "diagnostic_msgs/msg/diagnostic_status.hpp"
#include "rclcpp/rclcpp.hpp"

namespace deros_runtime_cpp
{

/// The state of a gate that is reported.
class GateStatus
{
public:
  virtual ~GateStatus() = default;

  /// Return for each line of the gate whether it applies.
  virtual const bool * applying() const = 0;

  /// Return since when the same lines have applied.
  virtual Time since() const = 0;
};

/// Publishes one status, periodically and soon after a change, which it also logs.
class GateReport
{
public:
  using Message = diagnostic_msgs::msg::DiagnosticArray;

  /**
   * \param lines the lines of the gate, in order
   * \param now the function that returns the time of the gate
   * \param target the topic of the commands that the gate publishes
   */
  GateReport(
    EventLoop & event_loop, rclcpp::Node & node, const GateStatus & gate,
    std::vector<std::string> lines, std::function<Time()> now,
    std::function<void(const Message &)> publish, const std::string & target);

  /// Publish for the first time, at once.
  void start();

  /// Report soon if other lines apply than were reported; this takes almost no time.
  void check();

  /// Count a rejected command.
  void refuse(const std::string & cause);

  /// Log a reset, and return the text of the response.
  /**
   * \param against the lines of the gate because of which it is refused
   */
  std::string answer(const std::vector<std::string> & against) const;

  /// Set the fault of a subject or, with an empty text, clear it.
  void fault(const std::string & subject, const std::string & text);

  /// Report publishers of a topic that do not match, and a second publisher.
  void check_publishers_of(SubscribedTopic topic);

private:
  void report_soon();
  void fire();
  void log() const;
  std::string applying() const;
  diagnostic_msgs::msg::DiagnosticStatus status() const;

  rclcpp::Node & node_;
  const GateStatus & gate_;
  const std::vector<std::string> lines_;
  std::function<Time()> now_;
  std::function<void(const Message &)> publish_;
  std::vector<bool> reported_;  // for each line, whether it applied in the last report
  std::size_t refused_{0};
  std::string cause_;
  std::vector<std::pair<std::string, std::string>> faults_;  // subjects and texts
  PublisherCheck publishers_;
  TargetPublisherCheck target_;
  OneShotTimer timer_;
};

}  // namespace deros_runtime_cpp

#endif  // DEROS_RUNTIME_CPP__GATE_REPORT_HPP_
