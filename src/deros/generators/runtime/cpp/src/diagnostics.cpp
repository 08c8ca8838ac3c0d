// Copyright and licence: see package.xml.

#include "deros_runtime_cpp/diagnostics.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdio>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "deros_runtime_cpp/text.hpp"

namespace deros_runtime_cpp
{

namespace
{

constexpr Time CHANGE_DELAY = 50'000'000;  // ns from a change to its message, to include others
constexpr std::size_t CHUNK = 8;  // statuses in one message, or looks ahead in one go: more would
// delay the monitor
constexpr Time PAUSE = 1'000'000;  // ns between the messages of one state

/// Return a time in seconds, as values show it.
std::string seconds_text(Time time)
{
  std::array<char, 64> text{};
  std::snprintf(text.data(), text.size(), "%.3f s", seconds(std::max<Time>(time, 0)));
  return text.data();
}

void add_since(Values & values, Time since, Time now, Time origin)
{
  values.emplace_back("since", seconds_text(now - since) + " ago");
  values.emplace_back("since_ns", std::to_string(since + origin));
}

}  // namespace

Diagnostics::Diagnostics(
  EventLoop & event_loop, const RuleMetadata & metadata, double frequency,
  Environment environment)
: metadata_(metadata),
  environment_(std::move(environment)),
  period_(std::llrint(1e9 / frequency)),
  actions_(metadata.actions.size()),
  timer_(event_loop, Clock(), [this] {fire();}, environment_.defer)
{
}

void Diagnostics::start()
{
  timer_.schedule(0);
}

void Diagnostics::changed()
{
  const Time soon = steady_now() + CHANGE_DELAY;
  if (!timer_.is_scheduled() || timer_.due() > soon) {
    timer_.schedule(soon);
  }
  has_changed_ = true;
}

void Diagnostics::update(const Event & event, const MonitorSnapshot & after)
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
  state.active = active && metadata_.actions[*site.action].has_state;
  state.behaviour = site.behaviour ? metadata_.behaviours[*site.behaviour].name : "";
  state.causes = site.behaviour ? cause_of(*site.behaviour, after) : "";
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

void Diagnostics::fire()
{
  if (published_ == statuses_.size() && !has_statuses()) {
    timer_.schedule(steady_now() + PAUSE);
    return;
  }
  const std::size_t count = std::min(CHUNK, statuses_.size() - published_);
  const auto first = statuses_.begin() + static_cast<std::ptrdiff_t>(published_);
  Message message;
  message.status.assign(first, first + static_cast<std::ptrdiff_t>(count));
  published_ += count;
  const bool is_incomplete = published_ < statuses_.size();
  timer_.schedule(steady_now() + (is_incomplete ? PAUSE : has_changed_ ? CHANGE_DELAY : period_));
  environment_.publish(message);
}

/// Look ahead from the present state for a while; return whether the statuses are made of it.
bool Diagnostics::has_statuses()
{
  if (!present_) {
    has_changed_ = false;
    const Time now = environment_.now();
    MonitorSnapshot state = environment_.snapshot();
    LookAhead ahead(state.rules, environment_.copies());
    present_ = Present{now, std::move(state), std::move(ahead), input_status(now)};
  }
  for (std::size_t i = 0; i < CHUNK; ++i) {
    if (!present_->ahead.step()) {
      make_statuses(*present_);
      present_.reset();
      published_ = 0;
      return true;
    }
  }
  return false;
}

void Diagnostics::make_statuses(const Present & present)
{
  const Time now = present.now;
  const MonitorSnapshot & state = present.state;
  statuses_.clear();
  statuses_.push_back(node_status(state.rules.size()));
  for (std::size_t i = 0; i < actions_.size(); ++i) {
    if (metadata_.actions[i].is_shown) {
      statuses_.push_back(action_status(i, now));
    }
  }
  const std::vector<bool> is_blamed = blamed(state);
  for (std::size_t i = 0; i < state.rules.size(); ++i) {
    statuses_.push_back(
      rule_status(state.rules[i], is_blamed[i], present.ahead.found()[i], now));
  }
  if (!metadata_.inputs.empty()) {
    statuses_.push_back(present.inputs);
  }
}

/// Return for each rule whether a behaviour holds because of it: it is true, or no other rule is.
std::vector<bool> Diagnostics::blamed(const MonitorSnapshot & state) const
{
  std::vector<bool> blamed(state.rules.size());
  for (const std::size_t behaviour : state.holding) {
    const auto & names = metadata_.behaviours[behaviour].rules;
    std::vector<std::size_t> named;
    std::vector<std::size_t> true_ones;
    for (std::size_t i = 0; i < state.rules.size(); ++i) {
      if (std::find(names.begin(), names.end(), state.rules[i].name) != names.end()) {
        named.push_back(i);
        if (state.rules[i].verdict == Verdict::True) {
          true_ones.push_back(i);
        }
      }
    }
    for (const std::size_t i : true_ones.empty() ? named : true_ones) {
      blamed[i] = true;
    }
  }
  return blamed;
}

Diagnostics::Status Diagnostics::node_status(std::size_t rule_count) const
{
  const std::string reason = environment_.not_ready_reason();
  std::vector<std::string> texts;
  Values values = {{"state", reason.empty() ? "watching" : reason}};
  for (const auto & fault : faults_) {
    texts.push_back(fault.second);
    values.push_back(fault);
  }
  std::string message = joined(texts, "; ");
  if (message.empty()) {
    message = reason.empty() ? "watching " + std::to_string(rule_count) + " rules" : reason;
  }
  const Level level = !faults_.empty() ? ERROR : reason.empty() ? OK : WARN;
  return status(level, environment_.name, message, values);
}

Diagnostics::Status Diagnostics::action_status(std::size_t action, Time now) const
{
  const Action & known = metadata_.actions[action];
  const ActionState & state = actions_[action];
  const std::string runs = std::to_string(state.runs);
  std::string message = state.active ? "active" : "inactive";
  if (!known.has_state) {
    message = "run " + runs + " times";
  }
  Values values = {{"runs", runs}};
  if (!state.behaviour.empty()) {
    values.emplace_back("cause", state.behaviour);
  }
  if (!state.causes.empty()) {
    values.emplace_back("because", state.causes);
  }
  if (state.since) {
    add_since(values, *state.since, now, environment_.origin());
  }
  const std::string name = environment_.name + ": action " + known.name;
  return status(state.active ? WARN : OK, name, message, values);
}

Diagnostics::Status Diagnostics::rule_status(
  const RuleState & rule, bool is_blamed, const std::vector<NextVerdict> & next, Time now) const
{
  Level level = STALE;
  if (rule.verdict != Verdict::Unknown) {
    level = is_blamed ? ERROR : rule.verdict == Verdict::True ? WARN : OK;
  }
  Values values;
  for (const Reading & reading : rule.reads) {
    values.emplace_back(reading.term, reading.value.value_or("unknown"));
  }
  if (!rule.causes.empty()) {
    values.emplace_back("cause", joined(rule.causes, "; "));
  }
  add_since(values, rule.since, now, environment_.origin());
  values.emplace_back("line", std::to_string(rule.line));
  for (const NextVerdict & each : next) {
    values.emplace_back(
      each.condition, to_text(each.verdict) + " in " + seconds_text(each.at - now));
  }
  const std::string message = to_text(rule.verdict) + ": " + rule.text;
  return status(level, environment_.name + ": " + rule.name, message, values);
}

/// Return the age of the last message of each input; a step back of the clock forgets it.
Diagnostics::Status Diagnostics::input_status(Time now) const
{
  Values values;
  std::vector<std::string> never;
  for (const Input & input : metadata_.inputs) {
    const std::optional<Time> at = environment_.received(input.topic);
    const bool is_known = at && *at <= now;
    values.emplace_back(input.name, is_known ? seconds_text(now - *at) + " ago" : "never");
    if (!is_known) {
      never.push_back(input.name);
    }
  }
  const std::string message =
    never.empty() ? "all received" : "never received: " + joined(never, ", ");
  return status(OK, environment_.name + ": inputs", message, values);
}

}  // namespace deros_runtime_cpp
