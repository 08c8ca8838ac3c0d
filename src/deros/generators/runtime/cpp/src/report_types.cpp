// Copyright and licence: see package.xml.

#include "deros_runtime_cpp/report_types.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace deros_runtime_cpp
{

std::string to_text(Verdict verdict)
{
  return verdict == Verdict::Unknown ? "unknown" : to_text(verdict == Verdict::True);
}

RuleState rule_state(
  const char * name, unsigned line, const char * text, bool is_true, Time since,
  std::vector<Reading> reads)
{
  const bool is_known = std::all_of(
    reads.begin(), reads.end(), [](const Reading & reading) {return reading.value.has_value();});
  const Verdict verdict = is_true ? Verdict::True : is_known ? Verdict::False : Verdict::Unknown;
  return {name, line, text, verdict, since, std::move(reads), {}};
}

std::optional<std::string> value_of(bool is_known, const std::string & value)
{
  return is_known ? std::optional<std::string>(value) : std::nullopt;
}

std::string known_text(std::uint32_t number, const std::vector<std::string> & texts)
{
  return number == 0 ? "another text" : texts[number - 1];
}

std::string rule_cause(const std::string & head, const Causes & causes)
{
  return head + joined(causes, "; ");
}

std::string unknown_terms_among(const std::vector<Reading> & reads)
{
  return unknown_terms_or(reads, {});
}

std::string unknown_terms_or(
  const std::vector<Reading> & reads, const std::vector<Reading> & results)
{
  std::vector<std::string> names;
  for (const auto * each : {&reads, &results}) {
    for (const Reading & reading : *each) {
      if (!reading.value) {
        names.push_back(reading.term);
      }
    }
    if (!names.empty()) {
      break;
    }
  }
  return "unknown: " + joined(names, ", ");
}

void append_unknown(Causes & causes, bool is_open, const Reading & reading)
{
  const std::string cause = reading.term + " is unknown";
  const bool is_new = std::find(causes.begin(), causes.end(), cause) == causes.end();
  if (is_open && !reading.value && is_new) {
    causes.push_back(cause);
  }
}

Causes cause_if(bool condition, const std::string & cause)
{
  return condition ? Causes{cause} : Causes();
}

Causes causes_if(bool condition, const Causes & causes)
{
  return condition ? causes : Causes();
}

void append(Causes & causes, const Causes & further)
{
  causes.insert(causes.end(), further.begin(), further.end());
}

std::string cause_of(std::size_t behaviour, const MonitorSnapshot & snapshot)
{
  const auto found = snapshot.causes.find(behaviour);
  return found == snapshot.causes.end() ? "" : found->second;
}

}  // namespace deros_runtime_cpp
