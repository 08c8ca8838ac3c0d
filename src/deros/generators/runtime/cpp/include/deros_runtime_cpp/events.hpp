// Copyright and licence: see package.xml.

#ifndef DEROS_RUNTIME_CPP__EVENTS_HPP_
#define DEROS_RUNTIME_CPP__EVENTS_HPP_

#include <cstddef>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "deros_runtime_cpp/report_types.hpp"
#include "diagnostic_msgs/msg/diagnostic_status.hpp"

namespace deros_runtime_cpp
{

/// How bad something is.
using Level = unsigned char;
constexpr Level OK = diagnostic_msgs::msg::DiagnosticStatus::OK;
constexpr Level WARN = diagnostic_msgs::msg::DiagnosticStatus::WARN;
constexpr Level ERROR = diagnostic_msgs::msg::DiagnosticStatus::ERROR;
constexpr Level STALE = diagnostic_msgs::msg::DiagnosticStatus::STALE;

/// Names and values, in order.
using Values = std::vector<std::pair<std::string, std::string>>;

/// Return a status of the diagnostics.
diagnostic_msgs::msg::DiagnosticStatus status(
  Level level, const std::string & name, const std::string & message, const Values & values);

/// Tells what happened, to the log and on a topic; always after it has been acted upon.
class Events
{
public:
  using Status = diagnostic_msgs::msg::DiagnosticStatus;
  using Log = std::function<void (Level, const std::string &)>;
  using Publish = std::function<void (const Status &)>;

  /// What tells of the node and of the world outside.
  struct Outside
  {
    std::string name;  // of the node, in full
    std::function<Time()> ros_now;
    Log log;
    Publish publish;
  };

  Events(const RuleMetadata & metadata, Outside outside);

  /// Tell of an event of the monitor.
  /**
   * \param done when it was acted upon, in the monitor's time
   * \param after what the monitor was worth after it
   */
  void ordered(const Event & event, Time done, const MonitorSnapshot & after);

  /// Tell of anything.
  void tell(const char * kind, Level level, const std::string & message, Values values = {});

  /// Return a behaviour with its place in the rules and its condition.
  std::string origin(std::size_t behaviour) const;

  /// Return why a reset of an action is refused; nothing if it is not.
  std::string refusal(std::size_t action, const MonitorSnapshot & present) const;

private:
  std::string origin_holding(std::size_t behaviour, const MonitorSnapshot & present) const;
  std::string origin_unknown(std::size_t behaviour, const MonitorSnapshot & present) const;
  std::vector<std::size_t> callers(
    std::size_t action, const std::vector<std::size_t> & among) const;
  std::string names(const std::vector<std::size_t> & behaviours) const;
  std::pair<std::string, Level> described(const Event & event, const MonitorSnapshot & after) const;

  const RuleMetadata & metadata_;
  Outside outside_;
};

}  // namespace deros_runtime_cpp

#endif  // DEROS_RUNTIME_CPP__EVENTS_HPP_
