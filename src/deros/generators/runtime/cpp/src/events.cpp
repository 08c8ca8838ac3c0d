// Copyright and licence: see package.xml.

#include "deros_runtime_cpp/events.hpp"

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

constexpr const char * KINDS[] = {"trigger", "reset", "refused", "clock_step"};

/// Set a value, where its name stands already or at the end.
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

std::string shown(const std::optional<bool> & value)
{
  return value ? deros_runtime_cpp::shown(*value) : "unknown";
}

/// Add what the rules are worth that a behaviour depends on, and what they read.
void add_values(Values & values, const Behaviour & behaviour, const MonitorSnapshot & after)
{
  for (const RuleState & rule : after.rules) {
    const auto & named = behaviour.rules;
    if (std::find(named.begin(), named.end(), rule.name) == named.end()) {
      continue;
    }
    set(values, "rule " + rule.name, shown(rule.value));
    for (const Reading & each : rule.reads) {
      set(values, "value " + each.term, each.value.value_or("unknown"));
    }
  }
}

}  // namespace

diagnostic_msgs::msg::DiagnosticStatus status(
  Level level, const std::string & name, const std::string & message, const Values & values)
{
  diagnostic_msgs::msg::DiagnosticStatus made;
  made.level = level;
  made.name = name;
  made.message = message;
  made.values.resize(values.size());
  for (std::size_t i = 0; i < values.size(); ++i) {
    made.values[i].key = values[i].first;
    made.values[i].value = values[i].second;
  }
  return made;
}

Events::Events(const RuleMetadata & metadata, Outside outside)
: metadata_(metadata), outside_(std::move(outside))
{
}

void Events::ordered(const Event & event, Time done, const MonitorSnapshot & after)
{
  const Site & site = metadata_.sites[event.site];
  const std::string line = std::to_string(site.line);
  Values values = {
    {"action", site.action ? metadata_.actions[*site.action].name : ""},
    {"origin", site.line != 0 ? metadata_.rules + ':' + line : ""},
    {"time_ns", std::to_string(event.t)},
    {"published_ns", std::to_string(done)},
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
    set(values, "holding", names(holding));
    set(values, "unknown", names(unknown));
    for (const std::size_t behaviour : holding) {
      set(values, "cause " + metadata_.behaviours[behaviour].name, cause_of(behaviour, after));
    }
    for (const auto & refusing : {holding, unknown}) {
      for (const std::size_t behaviour : refusing) {
        add_values(values, metadata_.behaviours[behaviour], after);
      }
    }
  }
  const auto [message, level] = described(event, after);
  tell(KINDS[static_cast<std::size_t>(event.kind)], level, message, std::move(values));
}

void Events::tell(const char * kind, Level level, const std::string & message, Values values)
{
  outside_.log(level, message);
  values.insert(values.begin(), {"kind", kind});
  values.emplace_back("ros_time_ns", std::to_string(outside_.ros_now()));
  outside_.publish(status(level, outside_.name, message, values));
}

std::string Events::origin(std::size_t behaviour) const
{
  const Behaviour & found = metadata_.behaviours[behaviour];
  return found.name + " (" + found.origin + ": if " + found.condition + ')';
}

std::string Events::refusal(std::size_t action, const MonitorSnapshot & present) const
{
  std::vector<std::string> holding;
  for (const std::size_t caller : callers(action, present.holding)) {
    holding.push_back(origin_holding(caller, present));
  }
  std::vector<std::string> unknown;
  for (const std::size_t caller : callers(action, present.unknown)) {
    unknown.push_back(origin_unknown(caller, present));
  }
  std::vector<std::string> reasons;
  if (!holding.empty()) {
    reasons.push_back("called for by " + joined(holding, ", "));
  }
  if (!unknown.empty()) {
    reasons.push_back("not known to be false: " + joined(unknown, ", "));
  }
  return joined(reasons, "; ");
}

/// Return a behaviour with its place in the rules, and what makes it hold.
std::string Events::origin_holding(std::size_t behaviour, const MonitorSnapshot & present) const
{
  const Behaviour & found = metadata_.behaviours[behaviour];
  const std::string cause = cause_of(behaviour, present);
  return cause.empty() ? origin(behaviour) : found.name + " (" + found.origin + "): " + cause;
}

/// Return a behaviour as origin() does, with the terms without a value.
std::string Events::origin_unknown(std::size_t behaviour, const MonitorSnapshot & present) const
{
  const std::vector<std::string> & rules = metadata_.behaviours[behaviour].rules;
  std::vector<std::string> terms;
  for (const RuleState & rule : present.rules) {
    if (rule.value || std::find(rules.begin(), rules.end(), rule.name) == rules.end()) {
      continue;
    }
    for (const Reading & each : rule.reads) {
      if (!each.value && std::find(terms.begin(), terms.end(), each.term) == terms.end()) {
        terms.push_back(each.term);
      }
    }
  }
  return terms.empty() ? origin(behaviour) :
         origin(behaviour) + ", unknown: " + joined(terms, ", ");
}

/// Return the behaviours among some that call for an action.
std::vector<std::size_t> Events::callers(
  std::size_t action, const std::vector<std::size_t> & among) const
{
  std::vector<std::size_t> found;
  for (const std::size_t caller : metadata_.actions[action].callers) {
    if (std::find(among.begin(), among.end(), caller) != among.end()) {
      found.push_back(caller);
    }
  }
  return found;
}

std::string Events::names(const std::vector<std::size_t> & behaviours) const
{
  std::vector<std::string> found;
  for (const std::size_t behaviour : behaviours) {
    found.push_back(metadata_.behaviours[behaviour].name);
  }
  return joined(found, ", ");
}

std::pair<std::string, Level> Events::described(
  const Event & event, const MonitorSnapshot & after) const
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
  const std::string & what = site.text.empty() ? action : site.text;
  return {what + ", by " + origin_holding(*site.behaviour, after), WARN};
}

}  // namespace deros_runtime_cpp
