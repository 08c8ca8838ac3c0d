// Copyright and licence: see package.xml.

#include "deros_runtime_cpp/diagnostics.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdio>
#include <string>
#include <utility>
#include <vector>

#include "deros_runtime_cpp/text.hpp"

namespace deros_runtime_cpp
{

namespace
{

constexpr Time SOON = 50'000'000;  // ns after a change, within which others are waited for
constexpr std::size_t CHUNK = 8;  // statuses in one message: more would keep the monitor waiting
constexpr Time PAUSE = 1'000'000;  // ns between the messages of one state

void add_since(Values & values, Time since, Time now)
{
  std::array<char, 64> text{};
  const double ago = static_cast<double>(std::max<Time>(now - since, 0)) / 1e9;
  std::snprintf(text.data(), text.size(), "%.3f s ago", ago);
  values.emplace_back("since", text.data());
  values.emplace_back("since_ns", std::to_string(since));
}

}  // namespace

Diagnostics::Diagnostics(
  EventLoop & event_loop, const RuleMetadata & metadata, double frequency, Outside outside)
: metadata_(metadata),
  outside_(std::move(outside)),
  period_(std::llrint(1e9 / frequency)),
  actions_(metadata.actions.size()),
  timer_(event_loop, Clock(), [this] {ring();}, outside_.defer)
{
}

void Diagnostics::begin()
{
  timer_.schedule(0);
}

void Diagnostics::changed()
{
  const Time soon = steady_now() + SOON;
  if (!timer_.is_scheduled() || timer_.due() > soon) {
    timer_.schedule(soon);
  }
  again_ = true;
}

void Diagnostics::ordered(const Event & event, const MonitorSnapshot & after)
{
  const Site & site = metadata_.sites[event.site];
  if (!site.action || (event.kind != EventKind::Trigger && event.kind != EventKind::Reset)) {
    return;
  }
  const bool active = event.kind == EventKind::Trigger;
  ActionState & state = actions_[*site.action];
  state.runs += active ? 1 : 0;
  if (state.active && active) {
    return;
  }
  state.active = active && metadata_.actions[*site.action].lasts;
  state.cause = site.behaviour ? metadata_.behaviours[*site.behaviour].name : "";
  state.because = site.behaviour ? cause_of(*site.behaviour, after) : "";
  state.since = event.t;
}

void Diagnostics::latched(std::size_t action)
{
  actions_[action] = {true, "active before the start", "", std::nullopt, 0};
}

bool Diagnostics::fault(const std::string & subject, const std::string & text)
{
  const auto found = std::find_if(
    faults_.begin(), faults_.end(), [&subject](const auto & each) {return each.first == subject;});
  if ((found == faults_.end() ? "" : found->second) == text) {
    return false;
  }
  if (found != faults_.end()) {
    faults_.erase(found);
  }
  if (!text.empty()) {
    faults_.emplace_back(subject, text);
  }
  changed();
  return true;
}

void Diagnostics::ring()
{
  if (published_ == statuses_.size()) {
    again_ = false;
    make_statuses();
    published_ = 0;
  }
  const std::size_t count = std::min(CHUNK, statuses_.size() - published_);
  const auto first = statuses_.begin() + static_cast<std::ptrdiff_t>(published_);
  Message message;
  message.status.assign(first, first + static_cast<std::ptrdiff_t>(count));
  published_ += count;
  const bool is_rest = published_ < statuses_.size();
  timer_.schedule(steady_now() + (is_rest ? PAUSE : again_ ? SOON : period_));
  outside_.publish(message);
}

void Diagnostics::make_statuses()
{
  const Time now = outside_.now();
  const MonitorSnapshot state = outside_.explain();
  statuses_.clear();
  statuses_.push_back(node_status(state.rules.size()));
  for (std::size_t i = 0; i < actions_.size(); ++i) {
    if (metadata_.actions[i].is_shown) {
      statuses_.push_back(action_status(i, now));
    }
  }
  const std::vector<bool> guilty = blamed(state);
  for (std::size_t i = 0; i < state.rules.size(); ++i) {
    statuses_.push_back(rule_status(state.rules[i], guilty[i], now));
  }
}

/// Tell of each rule whether a behaviour holds because of it: it is true, or none it names is.
std::vector<bool> Diagnostics::blamed(const MonitorSnapshot & state) const
{
  std::vector<bool> found(state.rules.size());
  for (const std::size_t behaviour : state.holding) {
    const auto & names = metadata_.behaviours[behaviour].rules;
    std::vector<std::size_t> named;
    std::vector<std::size_t> true_ones;
    for (std::size_t i = 0; i < state.rules.size(); ++i) {
      if (std::find(names.begin(), names.end(), state.rules[i].name) != names.end()) {
        named.push_back(i);
        if (state.rules[i].value.value_or(false)) {
          true_ones.push_back(i);
        }
      }
    }
    for (const std::size_t i : true_ones.empty() ? named : true_ones) {
      found[i] = true;
    }
  }
  return found;
}

Diagnostics::Status Diagnostics::node_status(std::size_t rule_count) const
{
  const std::string unready = outside_.summary();
  std::vector<std::string> texts;
  Values values = {{"state", unready.empty() ? "watching" : unready}};
  for (const auto & fault : faults_) {
    texts.push_back(fault.second);
    values.push_back(fault);
  }
  std::string message = joined(texts, "; ");
  if (message.empty()) {
    message = unready.empty() ? "watching " + std::to_string(rule_count) + " rules" : unready;
  }
  const Level level = !faults_.empty() ? ERROR : unready.empty() ? OK : WARN;
  return status(level, outside_.name, message, values);
}

Diagnostics::Status Diagnostics::action_status(std::size_t action, Time now) const
{
  const Action & known = metadata_.actions[action];
  const ActionState & state = actions_[action];
  const std::string runs = std::to_string(state.runs);
  std::string message = state.active ? "active" : "inactive";
  if (!known.lasts) {
    message = "run " + runs + " times";
  }
  Values values = {{"runs", runs}};
  if (!state.cause.empty()) {
    values.emplace_back("cause", state.cause);
  }
  if (!state.because.empty()) {
    values.emplace_back("because", state.because);
  }
  if (state.since) {
    add_since(values, *state.since, now);
  }
  const std::string name = outside_.name + ": action " + known.name;
  return status(state.active ? WARN : OK, name, message, values);
}

Diagnostics::Status Diagnostics::rule_status(const RuleState & rule, bool blamed, Time now) const
{
  Level level = STALE;
  if (rule.value) {
    level = blamed ? ERROR : *rule.value ? WARN : OK;
  }
  Values values;
  for (const Reading & each : rule.reads) {
    values.emplace_back(each.term, each.value.value_or("unknown"));
  }
  if (!rule.causes.empty()) {
    values.emplace_back("cause", joined(rule.causes, " and "));
  }
  add_since(values, rule.since, now);
  values.emplace_back("line", std::to_string(rule.line));
  const std::string verdict = rule.value ? shown(*rule.value) : "unknown";
  return status(
    level, outside_.name + ": " + rule.name, verdict + ": " + rule.text, values);
}

}  // namespace deros_runtime_cpp
