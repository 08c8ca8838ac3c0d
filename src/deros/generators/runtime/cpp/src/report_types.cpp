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

RuleState explained(
  const char * name, unsigned line, const char * text, bool is_true, Time since,
  std::vector<Reading> reads)
{
  const bool is_known = is_true || std::all_of(
    reads.begin(), reads.end(), [](const Reading & each) {return each.value.has_value();});
  const std::optional<bool> value = is_known ? std::optional<bool>(is_true) : std::nullopt;
  return {name, line, text, value, since, std::move(reads), {}};
}

std::optional<std::string> value_of(bool is_known, const std::string & value)
{
  return is_known ? std::optional<std::string>(value) : std::nullopt;
}

std::string text_of(std::uint32_t place, const std::vector<std::string> & known)
{
  return place == 0 ? "another text" : known[place - 1];
}

std::string because(const std::string & head, const Causes & causes)
{
  return head + joined(causes, " and ");
}

std::string unknown_among(const std::vector<Reading> & reads)
{
  std::vector<std::string> names;
  for (const Reading & each : reads) {
    if (!each.value) {
      names.push_back(each.term);
    }
  }
  return "unknown: " + joined(names, ", ");
}

Causes given(bool condition, const std::string & cause)
{
  return condition ? Causes{cause} : Causes();
}

Causes during(bool condition, const Causes & causes)
{
  return condition ? causes : Causes();
}

void add(Causes & all, const Causes & further)
{
  all.insert(all.end(), further.begin(), further.end());
}

std::string cause_of(std::size_t behaviour, const MonitorSnapshot & state)
{
  const auto found = std::find(state.holding.begin(), state.holding.end(), behaviour);
  return found == state.holding.end() ? "" :
         state.causes[static_cast<std::size_t>(found - state.holding.begin())];
}

}  // namespace deros_runtime_cpp
