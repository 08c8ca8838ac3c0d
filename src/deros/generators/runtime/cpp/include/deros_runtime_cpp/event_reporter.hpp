// Copyright and licence: see package.xml.

#ifndef DEROS_RUNTIME_CPP__EVENT_REPORTER_HPP_
#define DEROS_RUNTIME_CPP__EVENT_REPORTER_HPP_

#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "deros_runtime_cpp/report_types.hpp"
#include "diagnostic_msgs/msg/diagnostic_status.hpp"

namespace deros_runtime_cpp
{

/// The level of a status.
using Level = unsigned char;
constexpr Level OK = diagnostic_msgs::msg::DiagnosticStatus::OK;
constexpr Level WARN = diagnostic_msgs::msg::DiagnosticStatus::WARN;
constexpr Level ERROR = diagnostic_msgs::msg::DiagnosticStatus::ERROR;
constexpr Level STALE = diagnostic_msgs::msg::DiagnosticStatus::STALE;

/// Keys and values, in order.
using Values = std::vector<std::pair<std::string, std::string>>;

/// Return a diagnostic status.
diagnostic_msgs::msg::DiagnosticStatus status(
  Level level, const std::string & name, const std::string & message, const Values & values);

/// What a report is about; the first ones are the events of the monitor, as in EventKind.
enum class ReportKind
{
  Trigger,
  Reset,
  Refused,
  ClockStep,
  Start,
  NotPermitted,  // by the operating system
  Unfilled,  // an action without code
  Latched,  // an action that was active before the start
  Fault,
  Answered,  // success by the service of an action
  Undecodable,  // a message that cannot be deserialized
  Enabled,
  Disabled
};

/// Reports events to the log and on a topic, always after they have been executed.
class EventReporter
{
public:
  using Status = diagnostic_msgs::msg::DiagnosticStatus;
  using Log = std::function<void (Level, const std::string &)>;
  using Publish = std::function<void (const Status &)>;

  /// The node as the reporter uses it.
  struct Environment
  {
    std::string name;  // fully qualified
    std::function<Time()> ros_now;
    std::function<Time()> origin;  // what is added to times of the monitor
    Log log;
    Publish publish;
  };

  EventReporter(const RuleMetadata & metadata, Environment environment);

  /// Report an event of the monitor.
  /**
   * \param done when it was executed, in the time of the monitor
   * \param after the state of the monitor after it
   */
  void report_monitor_event(const Event & event, Time done, const MonitorSnapshot & after);

  /// Report anything.
  void report(ReportKind kind, Level level, const std::string & message, Values values = {});

  /// Return a behaviour with its place in the rules and its condition.
  std::string origin(std::size_t behaviour) const;

  /// Return why a reset of an action is refused; an empty text if it is not.
  std::string refusal(std::size_t action, const MonitorSnapshot & present) const;

private:
  std::string origin_holding(std::size_t behaviour, const MonitorSnapshot & present) const;
  std::string origin_unknown(std::size_t behaviour, const MonitorSnapshot & present) const;
  std::vector<std::size_t> callers(
    std::size_t action, const std::vector<std::size_t> & behaviours) const;
  std::string names(const std::vector<std::size_t> & behaviours) const;
  std::pair<std::string, Level> described(const Event & event, const MonitorSnapshot & after);
  std::pair<std::string, Level> described_trigger(
    const Event & event, const MonitorSnapshot & after);

  const RuleMetadata & metadata_;
  Environment environment_;
  // The behaviour whose cause was told last, and of which time.
  std::optional<std::pair<std::size_t, Time>> told_;
};

}  // namespace deros_runtime_cpp

#endif  // DEROS_RUNTIME_CPP__EVENT_REPORTER_HPP_
