// Copyright and licence: see package.xml.

#ifndef DEROS_RUNTIME_CPP__REPORT_TYPES_HPP_
#define DEROS_RUNTIME_CPP__REPORT_TYPES_HPP_

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "deros_runtime_cpp/event_loop.hpp"
#include "deros_runtime_cpp/text.hpp"

namespace deros_runtime_cpp
{

/// What a monitor did, or saw the clock do.
enum class EventKind { Trigger, Reset, Refused, ClockStep };

/// Something that happened to a monitor; site is the place in the rules that it comes from.
struct Event
{
  Time t;
  EventKind kind;
  std::size_t site;
};

/// A behaviour, for those who run it and those who read of it.
struct Behaviour
{
  std::string name;
  std::string origin;  // file and line of the rules
  std::string condition;
  std::vector<std::string> rules;  // that it depends on, also through the behaviours around it
  bool is_optional;
};

/// An action, for those who run it and those who read of it.
struct Action
{
  std::string name;
  bool is_bound;  // its state is published
  bool is_code;  // it is robot code
  bool lasts;  // it has a state, and is not just run
  bool is_shown;  // in the diagnostics
  std::optional<std::size_t> latch;  // its number among the latched actions
  std::optional<std::size_t> first_call;  // the site of its first call
  std::vector<std::size_t> callers;  // the behaviours that call for it, if it can be reset
};

/// A place in the rules that makes events.
struct Site
{
  std::optional<std::size_t> action;  // not of a step of the clock
  std::optional<std::size_t> behaviour;  // only of a call
  std::string arguments;  // of the call
  std::string text;  // what it says, if that is all it does
  unsigned line;  // in the rules; 0 for none
};

/// The rules as those know them who read the reports of a node.
struct RuleMetadata
{
  std::string rules;  // the name of their file
  std::size_t rule_count;
  std::string actions_file;  // where the user writes robot code
  std::vector<Behaviour> behaviours;
  std::vector<Action> actions;
  std::vector<Site> sites;  // the last one stands for steps of the clock
};

/// A term that a rule reads, and its value; none if that is unknown.
struct Reading
{
  Reading(std::string name, std::optional<std::string> its_value)
  : term(std::move(name)), value(std::move(its_value))
  {
  }

  std::string term;
  std::optional<std::string> value;
};

/// What makes something so: parts of conditions, each with its values.
using Causes = std::vector<std::string>;

/// What a rule is worth since the last event, and the values that it reads.
struct RuleState
{
  std::string name;
  unsigned line;  // in the rules
  std::string text;
  std::optional<bool> value;  // none: it is not true, and something that it reads is unknown
  Time since;  // when it last became true or ceased to be; else the start or the last clock step
  std::vector<Reading> reads;
  Causes causes;  // while it is true
};

/// Return the state of a rule of which is known whether it is true.
RuleState explained(
  const char * name, unsigned line, const char * text, bool is_true, Time since,
  std::vector<Reading> reads);

/// The same, with what it reads one by one.
template<typename ... Readings>
RuleState explained(
  const char * name, unsigned line, const char * text, bool is_true, Time since,
  Readings && ... reads)
{
  return explained(
    name, line, text, is_true, since, std::vector<Reading>{std::forward<Readings>(reads)...});
}

/// Return the value of a term, as text, if it is known.
template<typename Value>
std::optional<std::string> value_of(bool is_known, Value value)
{
  return is_known ? std::optional<std::string>(shown(value)) : std::nullopt;
}
std::optional<std::string> value_of(bool is_known, const std::string & value);

/// Return a text by its place, from 1, among those that the rules know.
std::string text_of(std::uint32_t place, const std::vector<std::string> & known);

/// Return the cause that is a rule, with its own causes.
std::string because(const std::string & head, const Causes & causes);

/// Return the cause that some of the terms that a rule reads have no value.
std::string unknown_among(const std::vector<Reading> & reads);

/// The same, with what it reads one by one.
template<typename ... Readings>
std::string unknown_of(Readings && ... reads)
{
  return unknown_among(std::vector<Reading>{std::forward<Readings>(reads)...});
}

/// Return a cause where a condition holds, and none elsewhere.
Causes given(bool condition, const std::string & cause);

/// Return causes where a condition holds, and none elsewhere.
Causes during(bool condition, const Causes & causes);

/// Add causes to others.
void add(Causes & all, const Causes & further);

/// Return the causes of all parts.
template<typename ... Parts>
Causes any_causes(const Parts & ... parts)
{
  Causes all;
  (add(all, parts), ...);
  return all;
}

/// Return the causes of all parts, where each of them has some, and none elsewhere.
template<typename ... Parts>
Causes all_causes(const Parts & ... parts)
{
  return (parts.empty() || ...) ? Causes() : any_causes(parts ...);
}

/// Return a time in seconds.
inline double seconds(Time time)
{
  return static_cast<double>(time) / 1e9;
}

/// All that a monitor is worth since an event.
struct MonitorSnapshot
{
  std::vector<RuleState> rules;
  std::vector<std::size_t> holding;  // the behaviours whose conditions hold
  std::vector<std::string> causes;  // of each of these, what makes it hold
  std::vector<std::size_t> unknown;  // the behaviours whose conditions are unknown
};

/// Return what makes a behaviour hold; nothing if it does not hold any more.
/**
 * A message may show that the clock has stepped back, and change at once what the step brought
 * about.
 */
std::string cause_of(std::size_t behaviour, const MonitorSnapshot & state);

}  // namespace deros_runtime_cpp

#endif  // DEROS_RUNTIME_CPP__REPORT_TYPES_HPP_
