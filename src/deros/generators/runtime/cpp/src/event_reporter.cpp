// Copyright and licence: see package.xml.

#include "deros_runtime_cpp/event_reporter.hpp"

#include <algorithm>
#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "deros_runtime_cpp/text.hpp"

namespace deros_runtime_cpp
{

namespace
{

// By which its reports are told from those of other nodes.
constexpr const char * HARDWARE_ID = "deros safety node";

const char * name_of(ReportKind kind)
{
  switch (kind) {
    case ReportKind::Trigger:
      return "trigger";
    case ReportKind::Reset:
      return "reset";
    case ReportKind::Refused:
      return "refused";
    case ReportKind::ClockStep:
      return "clock_step";
    case ReportKind::Start:
      return "start";
    case ReportKind::NotPermitted:
      return "not_permitted";
    case ReportKind::Unfilled:
      return "unfilled";
    case ReportKind::Latched:
      return "latched";
    case ReportKind::Fault:
      return "fault";
    case ReportKind::Answered:
      return "answered";
    case ReportKind::Undecodable:
      return "undecodable";
    case ReportKind::Enabled:
      return "enabled";
    case ReportKind::Disabled:
      return "disabled";
  }
  return "";
}

ReportKind kind_of(EventKind kind)
{
  switch (kind) {
    case EventKind::Trigger:
      return ReportKind::Trigger;
    case EventKind::Reset:
      return ReportKind::Reset;
    case EventKind::Refused:
      return ReportKind::Refused;
    case EventKind::ClockStep:
      return ReportKind::ClockStep;
  }
  return ReportKind::ClockStep;
}

/// Set the value of a key, or append it.
void set(Values & values, const std::string & name, std::string value)
{
  const auto found = std::find_if(
    values.begin(), values.end(), [&name](const auto & each) {return each.first == name;});
  if (found != values.end()) {
    found->second = std::move(value);
  } else {
    values.emplace_back(name, std::move(value));
  }
}

/// Add the verdicts of the rules that a behaviour depends on, and the values that they read.
void add_values(Values & values, const Behaviour & behaviour, const MonitorSnapshot & after)
{
  for (const RuleState & rule : after.rules) {
    const auto & named = behaviour.rules;
    if (std::find(named.begin(), named.end(), rule.name) == named.end()) {
      continue;
    }
    set(values, "rule " + rule.name, to_text(rule.verdict));
    for (const Reading & reading : rule.reads) {
      set(values, "value " + reading.term, reading.value.value_or("unknown"));
    }
  }
}

}  // namespace

diagnostic_msgs::msg::DiagnosticStatus status(
  Level level, const std::string & name, const std::string & message, const Values & values)
{
  diagnostic_msgs::msg::DiagnosticStatus status;
  status.level = level;
  status.name = name;
  status.message = message;
  status.hardware_id = HARDWARE_ID;
  status.values.resize(values.size());
  for (std::size_t i = 0; i < values.size(); ++i) {
    status.values[i].key = values[i].first;
    status.values[i].value = values[i].second;
  }
  return status;
}

EventReporter::EventReporter(const RuleMetadata & metadata, Environment environment)
: metadata_(metadata), environment_(std::move(environment))
{
}

void EventReporter::report_monitor_event(
  const Event & event, Time done, const MonitorSnapshot & after)
{
  const Site & site = metadata_.sites[event.site];
  const std::string line = std::to_string(site.line);
  Values values = {
    {"action", site.action ? metadata_.actions[*site.action].name : ""},
    {"origin", site.line != 0 ? metadata_.rules + ':' + line : ""},
    {"time_ns", std::to_string(event.t + environment_.origin())},
    {"published_ns", std::to_string(done + environment_.origin())},
  };
  if (!site.arguments.empty()) {
    set(values, "arguments", site.arguments);
  }
  if (site.behaviour) {
    const Behaviour & behaviour = metadata_.behaviours[*site.behaviour];
    set(values, "behaviour", behaviour.name);
    set(values, "origin", behaviour.origin);
    set(values, "condition", behaviour.condition);
    set(values, "cause", cause_of(*site.behaviour, after));
    add_values(values, behaviour, after);
  }
  if (event.kind == EventKind::Refused) {
    const std::vector<std::size_t> holding = callers(*site.action, after.holding);
    const std::vector<std::size_t> unknown = callers(*site.action, after.unknown);
    const std::vector<std::size_t> coming = callers(*site.action, after.coming);
    set(values, "holding", names(holding));
    set(values, "unknown", names(unknown));
    set(values, "coming", names(coming));
    for (const auto & refusing : {holding, unknown, coming}) {
      for (const std::size_t behaviour : refusing) {
        set(values, "cause " + metadata_.behaviours[behaviour].name, cause_of(behaviour, after));
      }
    }
    for (const auto & refusing : {holding, unknown, coming}) {
      for (const std::size_t behaviour : refusing) {
        add_values(values, metadata_.behaviours[behaviour], after);
      }
    }
  }
  const auto [message, level] = described(event, after);
  report(kind_of(event.kind), level, message, std::move(values));
}

void EventReporter::report(ReportKind kind, Level level, const std::string & message, Values values)
{
  environment_.log(level, message);
  values.insert(values.begin(), {"kind", name_of(kind)});
  values.emplace_back("ros_time_ns", std::to_string(environment_.ros_now()));
  environment_.publish(status(level, environment_.name, message, values));
}

std::string EventReporter::origin(std::size_t behaviour) const
{
  const Behaviour & named = metadata_.behaviours[behaviour];
  return named.name + " (" + named.origin + ": if " + named.condition + ')';
}

std::string EventReporter::refusal(std::size_t action, const MonitorSnapshot & present) const
{
  std::vector<std::string> holding;
  for (const std::size_t caller : callers(action, present.holding)) {
    holding.push_back(origin_holding(caller, present));
  }
  std::vector<std::string> coming;
  for (const std::size_t caller : callers(action, present.coming)) {
    coming.push_back(origin_holding(caller, present));
  }
  std::vector<std::string> unknown;
  for (const std::size_t caller : callers(action, present.unknown)) {
    unknown.push_back(origin_unknown(caller, present));
  }
  std::vector<std::string> reasons;
  if (!holding.empty()) {
    reasons.push_back("called for by " + joined(holding, ", "));
  }
  if (!coming.empty()) {
    reasons.push_back("on its way: " + joined(coming, ", "));
  }
  if (!unknown.empty()) {
    reasons.push_back("not known to be false: " + joined(unknown, ", "));
  }
  return joined(reasons, "; ");
}

/// Return a behaviour with its place in the rules, and its causes.
std::string EventReporter::origin_holding(
  std::size_t behaviour, const MonitorSnapshot & present) const
{
  const Behaviour & named = metadata_.behaviours[behaviour];
  const std::string cause = cause_of(behaviour, present);
  return cause.empty() ? origin(behaviour) : named.name + " (" + named.origin + "): " + cause;
}

/// Return a behaviour with its place in the rules, and what is unknown.
std::string EventReporter::origin_unknown(
  std::size_t behaviour, const MonitorSnapshot & present) const
{
  const Behaviour & named = metadata_.behaviours[behaviour];
  const std::string cause = cause_of(behaviour, present);
  return cause.empty() ? origin(behaviour) :
         named.name + " (" + named.origin + ": " + cause + ')';
}

/// Return the behaviours that call an action, among some.
std::vector<std::size_t> EventReporter::callers(
  std::size_t action, const std::vector<std::size_t> & behaviours) const
{
  std::vector<std::size_t> calling;
  for (const std::size_t caller : metadata_.actions[action].callers) {
    if (std::find(behaviours.begin(), behaviours.end(), caller) != behaviours.end()) {
      calling.push_back(caller);
    }
  }
  return calling;
}

std::string EventReporter::names(const std::vector<std::size_t> & behaviours) const
{
  std::vector<std::string> names;
  for (const std::size_t behaviour : behaviours) {
    names.push_back(metadata_.behaviours[behaviour].name);
  }
  return joined(names, ", ");
}

std::pair<std::string, Level> EventReporter::described(
  const Event & event, const MonitorSnapshot & after)
{
  if (event.kind == EventKind::ClockStep) {
    return {"the clock stepped back: all inputs are unknown until their next message", ERROR};
  }
  const Site & site = metadata_.sites[event.site];
  const std::string & action = metadata_.actions[*site.action].name;
  if (event.kind == EventKind::Reset) {
    return {action + " is reset", OK};
  }
  if (event.kind == EventKind::Refused) {
    return {action + " stays active, " + refusal(*site.action, after), WARN};
  }
  return described_trigger(event, after);
}

std::pair<std::string, Level> EventReporter::described_trigger(
  const Event & event, const MonitorSnapshot & after)
{
  const Site & site = metadata_.sites[event.site];
  const Action & action = metadata_.actions[*site.action];
  const bool only_says = !action.is_shown;
  const std::pair<std::size_t, Time> told{*site.behaviour, event.t};
  const bool is_told = told_ == told;  // with the cause, by another action
  told_ = told;
  const std::string by =
    is_told ? metadata_.behaviours[told.first].name : origin_holding(told.first, after);
  const bool is_fine = action.is_release || (only_says && is_told);
  return {(only_says ? site.text : action.name) + ", by " + by, is_fine ? OK : WARN};
}

}  // namespace deros_runtime_cpp
