// Copyright and licence: see package.xml.

#include "deros_runtime_cpp/look_ahead.hpp"

#include <cstddef>
#include <limits>
#include <utility>
#include <vector>

namespace deros_runtime_cpp
{

namespace
{

constexpr Time LATEST = std::numeric_limits<Time>::max() / 2;  // that of a monitor in C
constexpr std::size_t INSTANTS = 256;  // that are looked at in each case, at most

std::vector<Verdict> verdicts_of(const std::vector<RuleState> & rules)
{
  std::vector<Verdict> verdicts;
  verdicts.reserve(rules.size());
  for (const RuleState & rule : rules) {
    verdicts.push_back(rule.verdict);
  }
  return verdicts;
}

}  // namespace

LookAhead::LookAhead(const std::vector<RuleState> & rules, MonitorCopies copies)
: before_(verdicts_of(rules)),
  found_(rules.size())
{
  cases_[0].condition = "if values stay";
  cases_[0].copy = std::move(copies.staying);
  cases_[1].condition = "if no message comes";
  cases_[1].copy = std::move(copies.silent);
  for (Case & each : cases_) {
    each.is_found.resize(rules.size());
    each.left = rules.size();
    each.instants = INSTANTS;
  }
}

bool LookAhead::step()
{
  for (Case & each : cases_) {
    if (step(each)) {
      return true;
    }
  }
  return false;
}

/// Look at the next instant of one case; return false if there is none.
bool LookAhead::step(Case & played)
{
  if (!played.copy || played.left == 0 || played.instants == 0) {
    return false;
  }
  const Time due = played.copy->next_deadline();
  if (due >= LATEST) {
    return false;
  }
  --played.instants;
  played.copy->advance(due);
  const MonitorSnapshot after = played.copy->snapshot();
  for (std::size_t i = 0; i < before_.size(); ++i) {
    const Verdict verdict = after.rules[i].verdict;
    if (!played.is_found[i] && verdict != before_[i]) {
      played.is_found[i] = true;
      --played.left;
      found_[i].push_back({played.condition, verdict, due});
    }
  }
  return true;
}

}  // namespace deros_runtime_cpp
