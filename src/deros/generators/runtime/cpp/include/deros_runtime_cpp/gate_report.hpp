// Copyright and licence: see package.xml.

/// \file
/// What a gate does and why, on /diagnostics and in the log.

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

/// What is reported of the logic of a gate.
class GateStatus
{
public:
  virtual ~GateStatus() = default;

  /// Tell of each line of the gate whether it applies.
  virtual const bool * applying() const = 0;

  /// Tell since when the lines apply as they do.
  virtual Time since() const = 0;
};

/// Publishes one status, regularly and soon after a change, which it also logs.
class GateReport
{
public:
  using Message = diagnostic_msgs::msg::DiagnosticArray;

  /**
   * \param lines those of the gate, in order
   * \param now the gate's time
   * \param target the topic that the gate publishes commands on
   */
  GateReport(
    EventLoop & event_loop, rclcpp::Node & node, const GateStatus & gate,
    std::vector<std::string> lines, std::function<Time()> now,
    std::function<void(const Message &)> publish, const std::string & target);

  /// Publish for the first time, at once.
  void begin();

  /// Report soon if other lines apply than were reported; takes next to no time.
  void look();

  /// Count a command that was refused.
  void refuse(const std::string & cause);

  /// Log a reset, and return the answer to it.
  /**
   * \param against the lines of the gate that refuse it
   */
  std::string answer(const std::vector<std::string> & against) const;

  /// Note or, with an empty text, forget what is wrong with something.
  void fault(const std::string & subject, const std::string & text);

  /// Report of publishers on a topic that cannot be heard, and of a second one.
  void watch_over(SubscribedTopic topic);

private:
  void hurry();
  void ring();
  void log() const;
  std::string applying() const;
  diagnostic_msgs::msg::DiagnosticStatus status() const;

  rclcpp::Node & node_;
  const GateStatus & gate_;
  const std::vector<std::string> lines_;
  std::function<Time()> now_;
  std::function<void(const Message &)> publish_;
  std::vector<bool> told_;  // of each line whether it applied when that was reported last
  std::size_t refused_{0};
  std::string cause_;
  std::vector<std::pair<std::string, std::string>> faults_;  // each with what it is about
  Publishers publishers_;
  TargetPublishers target_;
  OneShotTimer timer_;
};

}  // namespace deros_runtime_cpp

#endif  // DEROS_RUNTIME_CPP__GATE_REPORT_HPP_
