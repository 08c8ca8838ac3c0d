// Copyright and licence: see package.xml.

/// \file
/// The types that the monitor, its runner and the reports have in common.

#ifndef DEROS_RUNTIME_CPP__REPORT_TYPES_HPP_
#define DEROS_RUNTIME_CPP__REPORT_TYPES_HPP_

#include <cstddef>
#include <cstdint>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "deros_runtime_cpp/event_loop.hpp"
#include "deros_runtime_cpp/text.hpp"

namespace deros_runtime_cpp
{

/// What a monitor did, or what happened to its clock; the values are those of the monitor in C.
enum class EventKind { Trigger, Reset, Refused, ClockStep };

/// An event of a monitor; the site is the number of the place in the rules that caused it.
struct Event
{
  Time t;
  EventKind kind;
  std::size_t site;
};

/// A behaviour of the rules.
struct Behaviour
{
  std::string name;
  std::string origin;  // file and line of the rules
  std::string condition;
  std::vector<std::string> rules;  // that it depends on, also through the behaviours around it
  bool is_optional;
};

/// An action of the rules.
struct Action
{
  std::string name;
  bool is_bound;  // its state is published
  bool is_code;  // it is implemented by robot code
  bool has_state;  // it becomes active and inactive, and is not just run
  bool is_shown;  // in the diagnostics
  bool is_release;  // all that it is for is to reset others
  std::optional<std::size_t> latch;  // its number among the latched actions
  std::optional<std::size_t> first_call;  // the site of its first call
  std::vector<std::size_t> callers;  // the behaviours that call it, if it can be reset
};

/// A place in the rules that causes events.
struct Site
{
  std::optional<std::size_t> action;  // none for a step of the clock
  std::optional<std::size_t> behaviour;  // only of a call
  std::string arguments;  // of the call
  std::string text;  // to be logged, if that is all the call does
  unsigned line;  // in the rules; 0 for none
};

/// An input of the rules, and the number of its topic among those that the node subscribes to.
struct Input
{
  std::string name;
  std::size_t topic;
};

/// The names and places in the rules that reports refer to.
struct RuleMetadata
{
  std::string rules;  // the name of their file
  std::size_t rule_count;
  std::string actions_file;  // where the user implements actions
  std::vector<Behaviour> behaviours;
  std::vector<Action> actions;
  std::vector<Site> sites;  // the last one stands for steps of the clock
  std::vector<Input> inputs;
};

/// A term that a rule reads, and its value; none if it is unknown.
struct Reading
{
  Reading(std::string name, std::optional<std::string> its_value)
  : term(std::move(name)), value(std::move(its_value))
  {
  }

  std::string term;
  std::optional<std::string> value;
};

/// The verdict of a rule; unknown: it is not true, and a term that it reads has no value.
enum class Verdict { False, True, Unknown };

/// Return a verdict as text.
std::string to_text(Verdict verdict);

/// The parts of conditions that make something true, each with its values.
using Causes = std::vector<std::string>;

/// The verdict of a rule since the last event, and the values behind it.
struct RuleState
{
  std::string name;
  unsigned line;  // in the rules
  std::string text;
  Verdict verdict;
  Time since;  // when it last became true or stopped being true; else the start or a clock step
  std::vector<Reading> reads;
  Causes causes;  // while it is true
};

/// Return the state of a rule, given whether it is true and the terms that it reads.
RuleState rule_state(
  const char * name, unsigned line, const char * text, bool is_true, Time since,
  std::vector<Reading> reads);

/// Return the state of a rule, with the terms as separate arguments.
template<typename ... Readings>
RuleState rule_state(
  const char * name, unsigned line, const char * text, bool is_true, Time since,
  Readings && ... reads)
{
  return rule_state(
    name, line, text, is_true, since, std::vector<Reading>{std::forward<Readings>(reads)...});
}

/// Return the value of a term as text, if it is known.
template<typename Value>
std::optional<std::string> value_of(bool is_known, Value value)
{
  return is_known ? std::optional<std::string>(to_text(value)) : std::nullopt;
}
std::optional<std::string> value_of(bool is_known, const std::string & value);

/// Return the text with a number, from 1, among those that the rules compare with.
std::string known_text(std::uint32_t number, const std::vector<std::string> & texts);

/// Return the cause that consists of a rule and its own causes.
std::string rule_cause(const std::string & head, const Causes & causes);

/// Return the cause that names the terms without a value among those that a rule reads.
std::string unknown_terms_among(const std::vector<Reading> & reads);

/// Return the same or, where all terms have a value, the cause that names the results without one.
std::string unknown_terms_or(
  const std::vector<Reading> & reads, const std::vector<Reading> & results);

/// Return terms with their values, which are separate arguments.
template<typename ... Readings>
std::vector<Reading> readings(Readings && ... reads)
{
  return std::vector<Reading>{std::forward<Readings>(reads)...};
}

/// Return the same, with the terms as separate arguments.
template<typename ... Readings>
std::string unknown_terms(Readings && ... reads)
{
  return unknown_terms_among(std::vector<Reading>{std::forward<Readings>(reads)...});
}

/// Append the cause that a term has no value, once, if it has none and whatever reads it is open.
void append_unknown(Causes & causes, bool is_open, const Reading & reading);

/// Return a cause if a condition is true, and none otherwise.
Causes cause_if(bool condition, const std::string & cause);

/// Return causes if a condition is true, and none otherwise.
Causes causes_if(bool condition, const Causes & causes);

/// Append causes to others.
void append(Causes & causes, const Causes & further);

/// Return the causes of all parts.
template<typename ... Parts>
Causes any_causes(const Parts & ... parts)
{
  Causes causes;
  (append(causes, parts), ...);
  return causes;
}

/// Return the causes of all parts if each part has some, and none otherwise.
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

/// Return the frequency of messages in Hz, without what is less than 1 µHz.
inline double per_second(std::int64_t messages, Time elapsed)
{
  if (elapsed <= 0) {
    return std::numeric_limits<double>::infinity();
  }
  return static_cast<double>(messages * 1'000'000'000'000'000 / elapsed) / 1e6;
}

/// The state of a monitor after an event.
struct MonitorSnapshot
{
  std::vector<RuleState> rules;
  std::vector<std::size_t> holding;  // the behaviours whose conditions hold
  std::vector<std::size_t> unknown;  // the behaviours whose conditions are unknown
  std::vector<std::size_t> coming;  // the behaviours whose conditions are on their way
  std::map<std::size_t, std::string> causes;  // of each that holds, is on its way, or refuses
};

/// Return the causes of a behaviour; an empty text if it has none any more.
/**
 * A message may reveal that the clock has stepped back, and change at once what the step caused.
 */
std::string cause_of(std::size_t behaviour, const MonitorSnapshot & snapshot);

}  // namespace deros_runtime_cpp

#endif  // DEROS_RUNTIME_CPP__REPORT_TYPES_HPP_
