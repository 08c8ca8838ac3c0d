// Copyright and licence: see package.xml.

#include "deros_runtime_cpp/gate_logic.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace deros_runtime_cpp
{

namespace
{

/// Return the place of a name.
std::size_t place_of(std::string_view name, const Rows<std::string_view> & names)
{
  const auto found = std::find(names.begin(), names.end(), name);
  if (found == names.end()) {
    throw std::invalid_argument("the table of the gate lacks " + std::string(name));
  }
  return static_cast<std::size_t>(found - names.begin());
}

/// Return whether a decision differs from another one.
bool is_same(const Limit * one, const Limit * other)
{
  if (one == nullptr || other == nullptr) {
    return one == other;
  }
  return one->lower == other->lower && one->upper == other->upper;
}

}  // namespace

bool is_any_active(std::initializer_list<ActionState> states)
{
  return std::any_of(
    states.begin(), states.end(), [](const ActionState & state) {return state.is_active;});
}

Gate::Gate(const Table & table, std::int64_t start)
: table_(table),
  choices_(table.lines.size() * table.fields.size(), nullptr),
  no_limits_(table.fields.size(), nullptr),
  active_(table.actions.size(), true),
  applies_(table.lines.size(), false),
  latched_(table.lines.size(), false),
  limits_(no_limits_),
  chosen_(no_limits_),
  since_(bounded(start))
{
  for (std::size_t number = 0; number < table.lines.size(); ++number) {
    const Line & line = table.lines[number];
    actions_.push_back(line.is_about_loss() ? 0 : place_of(line.when.action, table.actions));
    for (const Limit & limit : line.effect.limits) {
      choices_[number * table.fields.size() + place_of(limit.field, table.fields)] = &limit;
    }
  }
  applying_.resize(reports().size(), false);
  reported_.reserve(applying_.size());
  begin(since_);
}

/// Forget all but latches: actions count as active, and all that can be lost is lost.
void Gate::begin(std::int64_t t)
{
  now_ = called_ = t;
  active_.assign(active_.size(), true);
  heartbeat_ = input_ = LONG_AGO;
  counter_.reset();
  is_heartbeat_lost_ = true;
  waits_ = table_.resume_on_zero;
  zero_ = false;
  limits_ = no_limits_;
  zero_due_ = t;
  lost_due_ = NEVER;
}

// Events

void Gate::on_refused(std::int64_t t)
{
  advance(t);
  input_ = LONG_AGO;
  settle(now_);
}

void Gate::take_command(bool is_zero)
{
  input_ = now_;
  settle(now_, true, is_zero);
}

void Gate::on_state(
  std::int64_t t, std::initializer_list<ActionState> states, bool is_trusted)
{
  advance(t);
  for (const ActionState & state : states) {
    if (state.is_active || is_trusted) {
      active_[place_of(state.action, table_.actions)] = state.is_active;
    }
  }
  settle(now_);
}

void Gate::on_heartbeat(std::int64_t t, std::uint64_t counter)
{
  advance(t);
  heartbeat_ = counter_ && counter > *counter_ ? now_ : LONG_AGO;
  counter_ = counter;
  settle(now_);
}

void Gate::on_no_safety_node(std::int64_t t)
{
  advance(t);
  active_.assign(active_.size(), true);
  counter_.reset();
  heartbeat_ = LONG_AGO;
  settle(now_);
}

bool Gate::on_reset(std::int64_t t)
{
  advance(t);
  for (std::size_t line = 0; line < table_.lines.size(); ++line) {
    if (refuses(line)) {
      return false;
    }
  }
  latched_.assign(latched_.size(), false);
  settle(now_);
  return true;
}

bool Gate::refuses(std::size_t line) const
{
  const Line & row = table_.lines[line];
  return applying_[line] && (row.effect.zero || row.is_about_loss());
}

// Time

std::int64_t Gate::next_deadline() const
{
  return std::min(zero_due_, lost_due_);
}

void Gate::advance(std::int64_t t)
{
  t = bounded(t);
  called_ = t;
  if (t < now_) {
    begin(t);  // the clock stepped back
  }
  while (next_deadline() <= t) {
    settle(next_deadline());
  }
  now_ = t;
}

/// Return the instant from which a line about a loss applies.
std::int64_t Gate::loss(const Line & line) const
{
  return (line.when.cause == Cause::LOST_INPUT ? input_ : heartbeat_) + line.when.lost_ns;
}

// Decisions

/// Find the lines that apply at t, and publish; is_new: a command has just arrived.
void Gate::settle(std::int64_t t, bool is_new, bool is_zero)
{
  now_ = t;
  find_losses();
  find_lines();
  bool is_stopped = is_any_latched_;
  for (std::size_t line = 0; line < table_.lines.size(); ++line) {
    is_stopped = is_stopped || (applies_[line] && table_.lines[line].effect.zero);
  }
  // After zeros, nothing passes until a zero command arrives while no line commands zero.
  waits_ = table_.resume_on_zero && (is_stopped || (waits_ && !is_zero));
  choose_limits();
  follow(is_stopped || waits_, is_new);
  report(is_stopped);
}

/// Find what is lost, and when the next loss is.
void Gate::find_losses()
{
  const bool was_heartbeat_lost = is_heartbeat_lost_;
  is_heartbeat_lost_ = is_input_lost_ = false;
  lost_due_ = NEVER;
  for (const Line & line : table_.lines) {
    if (!line.is_about_loss()) {
      continue;
    }
    if (now_ < loss(line)) {
      lost_due_ = std::min(lost_due_, loss(line));
    } else if (line.when.cause == Cause::LOST_INPUT) {
      is_input_lost_ = true;
    } else {
      is_heartbeat_lost_ = true;
    }
  }
  if (is_heartbeat_lost_ && !was_heartbeat_lost) {
    active_.assign(active_.size(), true);  // they may change unseen until their next message
  }
}

/// Find which lines apply, and which are latched.
void Gate::find_lines()
{
  const bool is_lost = is_heartbeat_lost_ || is_input_lost_;
  is_any_latched_ = false;
  for (std::size_t number = 0; number < table_.lines.size(); ++number) {
    const Line & line = table_.lines[number];
    applies_[number] = line.is_about_loss() ?
      now_ >= loss(line) : active_[actions_[number]] && (line.effect.zero || !is_lost);
    latched_[number] = latched_[number] || (applies_[number] && line.effect.until_reset);
    is_any_latched_ = is_any_latched_ || latched_[number];
  }
}

/// Choose the limits in force: none where every number is zero.
void Gate::choose_limits()
{
  for (std::size_t field = 0; field < chosen_.size(); ++field) {
    chosen_[field] = is_any_latched_ || waits_ ? nullptr : limit_of(field);
  }
}

/// Return what the first line that names a field says; a line with zero names all fields.
const Limit * Gate::limit_of(std::size_t field) const
{
  for (std::size_t line = 0; line < table_.lines.size(); ++line) {
    const Limit * limit = choices_[line * chosen_.size() + field];
    if (applies_[line] && (limit != nullptr || table_.lines[line].effect.zero)) {
      return limit;
    }
  }
  return nullptr;
}

/// Publish what the lines that apply decide.
void Gate::follow(bool zero, bool is_new)
{
  const bool is_changed =
    zero != zero_ || !std::equal(chosen_.begin(), chosen_.end(), limits_.begin(), is_same);
  zero_ = zero;
  limits_ = chosen_;
  if (zero) {
    if (is_changed || now_ >= zero_due_) {
      // One message replaces all that are overdue in a late call.
      zero_due_ = now_ + table_.period_ns * ((called_ - now_) / table_.period_ns + 1);
      make_zero(is_input_lost_ ? no_limits_ : limits_);
    }
    return;
  }
  zero_due_ = NEVER;
  if (is_new) {
    execute(limits_);
  } else {
    limit(limits_);
  }
}

// Reports

void Gate::report(bool is_stopped)
{
  reported_.clear();
  reported_.insert(reported_.end(), applies_.begin(), applies_.end());
  for (std::size_t line = 0; line < table_.lines.size(); ++line) {
    if (table_.lines[line].effect.until_reset) {
      reported_.push_back(latched_[line] && !applies_[line]);
    }
  }
  if (table_.resume_on_zero) {
    reported_.push_back(waits_ && !is_stopped);
  }
  if (reported_ != applying_) {
    applying_ = reported_;
    since_ = now_;
  }
}

std::vector<std::string> Gate::reports() const
{
  std::vector<std::string> texts;
  for (const Line & line : table_.lines) {
    texts.emplace_back(line.text);
  }
  for (const Line & line : table_.lines) {
    if (line.effect.until_reset) {
      texts.push_back("waits for a reset, after " + std::string(line.text));
    }
  }
  if (table_.resume_on_zero) {
    texts.emplace_back("waits for a zero command");
  }
  return texts;
}

}  // namespace deros_runtime_cpp
