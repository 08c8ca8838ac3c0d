// Copyright and licence: see package.xml.

#ifndef DEROS_RUNTIME_CPP__DIAGNOSTICS_HPP_
#define DEROS_RUNTIME_CPP__DIAGNOSTICS_HPP_

#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "deros_runtime_cpp/event_loop.hpp"
#include "deros_runtime_cpp/events.hpp"
#include "deros_runtime_cpp/report_types.hpp"
#include "diagnostic_msgs/msg/diagnostic_array.hpp"
#include "diagnostic_msgs/msg/diagnostic_status.hpp"

namespace deros_runtime_cpp
{

/// The present state of a safety node on /diagnostics, for the tools that operators know.
/**
 * One status for the node, one for each action and one for each rule. All of it is published
 * regularly, and soon after a change.
 */
class Diagnostics
{
public:
  using Message = diagnostic_msgs::msg::DiagnosticArray;
  using Status = diagnostic_msgs::msg::DiagnosticStatus;

  /// What tells of the node and of the world outside.
  struct Outside
  {
    std::string name;  // of the node, in full
    std::function<MonitorSnapshot()> explain;
    std::function<Time()> now;  // the time in which the monitor is told
    std::function<std::string()> summary;  // what the node is not ready for; empty if it watches
    std::function<void(Message &)> publish;  // stamps it, too
    std::function<Time()> defer;  // what goes before
  };

  Diagnostics(
    EventLoop & event_loop, const RuleMetadata & metadata, double frequency, Outside outside);

  /// Publish for the first time, at once.
  void begin();

  /// Publish soon.
  void changed();

  /// Follow an event of the monitor; after is what the monitor was worth after it.
  void ordered(const Event & event, const MonitorSnapshot & after);

  /// Show an action as active that was so before the start.
  void latched(std::size_t action);

  /// Note or, with an empty text, forget a fault; tell whether this is another one now.
  bool fault(const std::string & subject, const std::string & text);

private:
  /// An action: whether it is active, or that it ran, by which behaviour and why, since when.
  struct ActionState
  {
    bool active = false;
    std::string cause;
    std::string because;
    std::optional<Time> since;
    std::size_t runs = 0;
  };

  void ring();
  void make_statuses();
  Status node_status(std::size_t rule_count) const;
  Status action_status(std::size_t action, Time now) const;
  Status rule_status(const RuleState & rule, bool blamed, Time now) const;
  std::vector<bool> blamed(const MonitorSnapshot & state) const;

  const RuleMetadata & metadata_;
  Outside outside_;
  Time period_;
  Values faults_;
  std::vector<ActionState> actions_;
  std::vector<Status> statuses_;  // of one state, published in parts
  std::size_t published_ = 0;
  bool again_ = false;
  OneShotTimer timer_;
};

}  // namespace deros_runtime_cpp

#endif  // DEROS_RUNTIME_CPP__DIAGNOSTICS_HPP_
