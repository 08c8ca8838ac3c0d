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
#include "deros_runtime_cpp/gate_logic.hpp"
#include "deros_runtime_cpp/publishers.hpp"
#include "deros_runtime_cpp/target_publishers.hpp"
#include "diagnostic_msgs/msg/diagnostic_array.hpp"
#include "diagnostic_msgs/msg/diagnostic_status.hpp"
#include "rclcpp/rclcpp.hpp"

namespace deros_runtime_cpp
{

/// Publishes one status, periodically and soon after a change, which it also logs.
class GateReport
{
public:
  using Message = diagnostic_msgs::msg::DiagnosticArray;

  /**
   * \param now the function that returns the time of the gate
   * \param target the topic of the commands that the gate publishes
   */
  GateReport(
    EventLoop & event_loop, rclcpp::Node & node, const Gate & gate, Clock clock,
    std::function<void(const Message &)> publish, const std::string & target);

  /// Publish for the first time, at once.
  void start();

  /// Report soon if another line or source applies; this takes almost no time.
  void check();

  /// Count a rejected command.
  void refuse(const std::string & cause);

  /// Log whether the gate has been reset, and return the text of the response.
  std::string answer(bool is_reset) const;

  /// Set the fault of a subject or, with an empty text, clear it.
  void fault(const std::string & subject, const std::string & text);

  /// Report publishers of a topic that do not match, and a second publisher.
  void check_publishers_of(SubscribedTopic topic);

private:
  void report_soon();
  void fire();
  bool awaits_clock() const;
  void log() const;
  std::string applying() const;
  std::string fine() const;
  diagnostic_msgs::msg::DiagnosticStatus status() const;

  rclcpp::Node & node_;
  const Gate & gate_;
  const std::vector<std::string> texts_;  // of everything that can hold commands back
  Clock clock_;
  std::function<void(const Message &)> publish_;
  const bool is_simulated_;  // whether the time of the node is that of /clock
  std::vector<bool> reported_;  // for each text, whether it applied in the last report
  std::string source_;  // in the last report
  std::size_t refused_{0};
  std::string cause_;
  std::vector<std::pair<std::string, std::string>> faults_;  // subjects and texts
  PublisherCheck publishers_;
  TargetPublisherCheck target_;
  OneShotTimer timer_;
};

}  // namespace deros_runtime_cpp

#endif  // DEROS_RUNTIME_CPP__GATE_REPORT_HPP_
