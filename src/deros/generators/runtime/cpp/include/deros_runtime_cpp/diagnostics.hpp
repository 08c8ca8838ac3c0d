// Copyright and licence: see package.xml.

#ifndef DEROS_RUNTIME_CPP__DIAGNOSTICS_HPP_
#define DEROS_RUNTIME_CPP__DIAGNOSTICS_HPP_

#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "deros_runtime_cpp/event_loop.hpp"
#include "deros_runtime_cpp/event_reporter.hpp"
#include "deros_runtime_cpp/look_ahead.hpp"
#include "deros_runtime_cpp/report_types.hpp"
#include "diagnostic_msgs/msg/diagnostic_array.hpp"
#include "diagnostic_msgs/msg/diagnostic_status.hpp"

namespace deros_runtime_cpp
{

/// Publishes the present state of a safety node on /diagnostics, for the usual tools of operators.
/**
 * There is one status for the node, for each action, for each rule, and for all inputs. All of them
 * are published periodically, and soon after a change.
 */
class Diagnostics
{
public:
  using Message = diagnostic_msgs::msg::DiagnosticArray;
  using Status = diagnostic_msgs::msg::DiagnosticStatus;

  /// The node as the diagnostics use it.
  struct Environment
  {
    std::string name;  // fully qualified
    std::function<MonitorSnapshot()> snapshot;
    std::function<Time()> now;  // the time of the monitor
    std::function<Time()> origin;  // what is added to such times
    std::function<std::string()> not_ready_reason;  // empty if the node watches all rules
    std::function<void(Message &)> publish;  // stamps the message, too
    std::function<Time()> defer;  // for how long publishing has to wait
    std::function<MonitorCopies()> copies;  // of the monitor; none while no time passes
    std::function<std::optional<Time>(std::size_t)> received;  // the last message of a topic
  };

  Diagnostics(
    EventLoop & event_loop, const RuleMetadata & metadata, double frequency,
    Environment environment);

  /// Publish for the first time, at once.
  void start();

  /// Publish soon.
  void changed();

  /// Update the state of an action after an event of the monitor.
  void update(const Event & event, const MonitorSnapshot & after);

  /// Mark an action as active since before the start.
  void latched(std::size_t action);

  /// Set a fault or, with an empty text, clear it; return whether that changed the fault.
  bool fault(const std::string & subject, const std::string & text);

private:
  /// The state of an action: whether and since when it is active or has run, and why.
  struct ActionState
  {
    bool active = false;
    std::string behaviour;
    std::string causes;
    std::optional<Time> since;
    std::size_t runs = 0;
  };

  /// The state that is being published, while the node looks ahead from it.
  struct Present
  {
    Time now;
    MonitorSnapshot state;
    LookAhead ahead;
    Status inputs;
  };

  void fire();
  bool has_statuses();
  void make_statuses(const Present & present);
  Status input_status(Time now) const;
  Status node_status(std::size_t rule_count) const;
  Status action_status(std::size_t action, Time now) const;
  Status rule_status(
    const RuleState & rule, bool is_blamed, const std::vector<NextVerdict> & next, Time now) const;
  std::vector<bool> blamed(const MonitorSnapshot & state) const;

  const RuleMetadata & metadata_;
  Environment environment_;
  Time period_;
  Values faults_;
  std::vector<ActionState> actions_;
  std::optional<Present> present_;  // while statuses are still to be made of it
  std::vector<Status> statuses_;  // of one state, published in parts
  std::size_t published_ = 0;
  bool has_changed_ = false;  // since the state that is being published
  OneShotTimer timer_;
};

}  // namespace deros_runtime_cpp

#endif  // DEROS_RUNTIME_CPP__DIAGNOSTICS_HPP_
