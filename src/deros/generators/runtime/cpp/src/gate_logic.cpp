// Copyright and licence: see package.xml.

#include "deros_runtime_cpp/gate_logic.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <limits>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace deros_runtime_cpp
{

namespace
{

constexpr double ALL_THE_WAY = std::numeric_limits<double>::infinity();

constexpr Effect AT_ONCE = zero();

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

Gate::Gate(const Table & table, std::int64_t start, std::vector<double> parameters)
: table_(table),
  choices_(table.lines.size() * table.fields.size(), nullptr),
  no_limits_(table.fields.size(), nullptr),
  standing_(table, std::move(parameters)),
  active_(table.actions.size(), true),
  active_since_(table.actions.size(), NEVER),
  applies_(table.lines.size(), false),
  latched_(table.lines.size(), false),
  limits_(no_limits_),
  chosen_(no_limits_),
  fell_(table.fields.size(), 0.0),
  drops_(table.fields.size(), ALL_THE_WAY),
  falls_since_(table.fields.size(), bounded(start)),
  since_(bounded(start)),
  sources_(table.sources)
{
  for (std::size_t number = 0; number < table.lines.size(); ++number) {
    const Line & line = table.lines[number];
    const bool is_about_action = line.when.cause == Cause::ACTION;
    actions_.push_back(is_about_action ? place_of(line.when.action, table.actions) : 0);
    for (const Limit & limit : line.effect.limits) {
      const std::size_t field = place_of(limit.field, table.fields);
      choices_[number * table.fields.size() + field] = &limit;
      if (line.when.cause == Cause::STANDING) {
        standing_.set(field, limit, table.bounds);
      }
    }
    for (const Ramp & ramp : line.effect.ramps) {
      place_of(ramp.field, table.fields);
    }
    has_waits_ = has_waits_ || line.effect.wait_ns != 0;
    if (line.effect.stop == Stop::ZERO) {
      rest_ = &AT_ONCE;
    }
  }
  while (deciding_ < table.lines.size() && !table.lines[deciding_].effect.stops()) {
    ++deciding_;  // at the start, the first line that stops says how
  }
  applying_.resize(reports().size(), false);
  reported_.reserve(applying_.size());
  begin(since_);
}

/// Forget all but latches: actions count as active, and all that can be lost is lost.
void Gate::begin(std::int64_t t)
{
  now_ = called_ = t;
  forget_actions();
  moves_ = is_held_ = false;
  wished_since_ = NEVER;
  heartbeat_ = LONG_AGO;
  sources_.forget();
  standing_.forget();
  has_fallen_ = is_falling_ = false;
  counter_.reset();
  is_heartbeat_lost_ = true;
  waits_ = table_.resume_on_zero;
  takes_over_ = false;
  stop_ = nullptr;
  limits_ = no_limits_;
  zero_due_ = t;
  lost_due_ = NEVER;
}

// Events

void Gate::on_refused(std::int64_t t, std::size_t source)
{
  advance(t);
  sources_.take(now_, source, false, false);
  settle(now_);
}

void Gate::take_command(std::size_t source, bool is_safe)
{
  sources_.take(now_, source, true, is_safe);
  has_command_ = has_command_ || source == source_;
  settle(now_);
}

void Gate::on_state(
  std::int64_t t, std::initializer_list<ActionState> states, bool is_trusted)
{
  advance(t);
  for (const ActionState & state : states) {
    if (state.is_active || is_trusted) {
      const std::size_t action = place_of(state.action, table_.actions);
      active_[action] = state.is_active;
      if (!state.is_active) {
        active_since_[action] = NEVER;
      } else if (is_trusted) {
        active_since_[action] = std::min(active_since_[action], now_);
      }
    }
  }
  settle(now_);
}

void Gate::on_inputs(std::int64_t t, std::initializer_list<InputNumber> numbers)
{
  advance(t);
  standing_.take(now_, numbers);
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
  forget_actions();
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
  return applying_[line] && (row.effect.stops() || row.is_about_loss());
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
  return (line.when.cause == Cause::LOST_INPUT ? sources_.lost_from() : heartbeat_) +
         line.when.lost_ns;
}

// Decisions

/// Find the lines that apply at t, and publish.
void Gate::settle(std::int64_t t)
{
  now_ = t;
  standing_.settle(t);
  const bool is_new = choose_source();
  find_losses();
  find_lines();
  const bool is_stopped = find_stop();
  // After a stop, nothing passes until a zero command arrives while no line stops.
  const bool is_safe = is_new && sources_.is_safe() && !is_stopped;
  waits_ = table_.resume_on_zero && (is_stopped || waits_) && !is_safe;
  takes_over_ = takes_over_ && !is_safe;
  const Effect * stopping = is_stopped || is_waiting() ? &stop() : nullptr;
  is_held_ = find_wait(stopping, is_new, is_safe);
  if (is_held_) {
    stopping = rest_ != nullptr ? rest_ : &stop();
  }
  choose_limits(is_held_ || (stopping != nullptr && stopping->stop != Stop::ZERO));
  follow(stopping, is_new);
  report(is_stopped);
}

/// Choose a source; return whether a command is new.
bool Gate::choose_source()
{
  const bool is_new = sources_.choose(now_);
  if (sources_.has_changed()) {
    takes_over_ = table_.sources.size() != 0 && sources_.is_any_chosen() &&
      table_.sources[sources_.chosen()].from_zero;
  }
  if (is_new) {
    source_ = sources_.chosen();
    has_command_ = true;
  }
  return is_new;
}

std::string_view Gate::source_name() const
{
  const bool is_one_of_several = table_.sources.size() != 0 && sources_.is_any_chosen();
  return is_one_of_several ? table_.sources[sources_.chosen()].topic : std::string_view();
}

/// Find the first line that stops; return whether there is one.
bool Gate::find_stop()
{
  for (std::size_t line = 0; line < table_.lines.size(); ++line) {
    if (table_.lines[line].effect.stops() && (applies_[line] || latched_[line])) {
      deciding_ = line;
      return true;
    }
  }
  return false;
}

/// Return how the gate stops; a gate of which no line stops can still wait, at zero.
const Effect & Gate::stop() const
{
  return deciding_ < table_.lines.size() ? table_.lines[deciding_].effect : AT_ONCE;
}

/// Count actions as active, though not as known to be.
void Gate::forget_actions()
{
  active_.assign(active_.size(), true);
  active_since_.assign(active_since_.size(), NEVER);
}

/// Return whether a command that moves waits; is_new: one has just come.
bool Gate::find_wait(const Effect * stop, bool is_new, bool is_safe)
{
  if (!has_waits_) {
    return false;
  }
  if (stop != nullptr || is_input_lost_ || (is_new && is_safe)) {
    wished_since_ = NEVER;
    // What is held may move; after a silence, nobody knows.
    moves_ = moves_ && stop != nullptr && stop->stop == Stop::HOLD;
    return false;
  }
  if (!is_new) {
    return wished_since_ != NEVER;
  }
  if (!moves_ && wished_since_ == NEVER) {
    wished_since_ = now_;
  }
  moves_ = moves_ || has_waited();
  if (moves_) {
    wished_since_ = NEVER;
  }
  return !moves_;
}

/// Return whether each action has been active for long enough since the wish to move.
bool Gate::has_waited() const
{
  for (std::size_t number = 0; number < table_.lines.size(); ++number) {
    const std::int64_t wait_ns = table_.lines[number].effect.wait_ns;
    const std::int64_t since = active_since_[actions_[number]];
    if (wait_ns != 0 && (since == NEVER || now_ < std::max(since, wished_since_) + wait_ns)) {
      return false;
    }
  }
  return true;
}

/// Find what is lost, and when the next loss is.
void Gate::find_losses()
{
  const bool was_heartbeat_lost = is_heartbeat_lost_;
  is_heartbeat_lost_ = is_input_lost_ = false;
  lost_due_ = std::min(sources_.due(), standing_.due());
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
    forget_actions();  // they may change unseen until their next message
  }
}

/// Find which lines apply, and which are latched.
void Gate::find_lines()
{
  const bool is_lost = is_heartbeat_lost_ || is_input_lost_;
  is_any_latched_ = false;
  for (std::size_t number = 0; number < table_.lines.size(); ++number) {
    const Line & line = table_.lines[number];
    if (line.is_about_loss()) {
      applies_[number] = now_ >= loss(line);
    } else if (line.when.cause == Cause::ACTION && line.effect.wait_ns == 0) {
      applies_[number] = active_[actions_[number]] && (line.effect.stops() || !is_lost);
    }  // standing limits, and waits, hold beside the lines that apply
    latched_[number] = latched_[number] || (applies_[number] && line.effect.until_reset);
    is_any_latched_ = is_any_latched_ || latched_[number];
  }
}

/// Choose the limits in force beside the standing ones: none where the stop is whole.
void Gate::choose_limits(bool is_whole)
{
  for (std::size_t field = 0; field < chosen_.size(); ++field) {
    chosen_[field] = is_any_latched_ || is_waiting() || is_whole ? nullptr : limit_of(field);
  }
}

/// Return what the first line that names a field says; a line that stops names all fields.
const Limit * Gate::limit_of(std::size_t field) const
{
  for (std::size_t line = 0; line < table_.lines.size(); ++line) {
    const Limit * limit = choices_[line * chosen_.size() + field];
    if (applies_[line] && (limit != nullptr || table_.lines[line].effect.stops())) {
      return limit;
    }
  }
  return nullptr;
}

/// Return whether the gate already stops, or passes commands, in this way.
bool Gate::is_as_decided(const Effect * stop) const
{
  if (stop == nullptr || stop_ == nullptr) {
    return stop == stop_;
  }
  if (stop->stop == Stop::SEND && deciding_ != decided_) {
    return false;
  }
  return stop->stop == stop_->stop && std::equal(
    stop->ramps.begin(), stop->ramps.end(), stop_->ramps.begin(), stop_->ramps.end(),
    [](const Ramp & one, const Ramp & other) {
      return one.field == other.field && one.rate == other.rate;
    });
}

/// Publish what the lines that apply decide.
void Gate::follow(const Effect * stop, bool is_new)
{
  const bool is_changed = !is_as_decided(stop);
  const bool is_other_limit =
    !std::equal(chosen_.begin(), chosen_.end(), limits_.begin(), is_same);
  if (stop != nullptr && is_changed) {
    start_ramps();
  }
  stop_ = stop;
  decided_ = deciding_;
  limits_ = chosen_;
  if (stop != nullptr) {
    if (is_changed || is_other_limit || now_ >= zero_due_ || exceeds_limits(*stop)) {
      publish_stop(*stop);
    }
    return;
  }
  zero_due_ = NEVER;
  if (is_new) {
    is_executing_ = true;
    is_falling_ = false;
    execute(limits_);
  } else if (is_executing_) {
    limit(limits_);
  }
}

/// Return whether what the gate stops with was published before the limits became narrower.
bool Gate::exceeds_limits(const Effect & stop)
{
  const bool can_exceed = stop.stop == Stop::ZERO || (stop.stop == Stop::HOLD && is_executing_);
  return standing_.can_change() && can_exceed && narrow();
}

/// Publish what the gate stops with; one message replaces all that are overdue in a late call.
void Gate::publish_stop(const Effect & stop)
{
  zero_due_ = now_ + table_.period_ns * ((called_ - now_) / table_.period_ns + 1);
  if (stop.stop == Stop::HOLD) {
    if (is_executing_) {
      hold();
    }
    return;
  }
  is_executing_ = false;
  is_falling_ = stop.stop == Stop::ZERO && has_command_;
  if (stop.stop == Stop::SILENCE) {
    zero_due_ = NEVER;
  } else if (stop.stop == Stop::SEND) {
    send(deciding_);
  } else {
    find_drops(called_);
    if (is_input_lost_) {
      stop_limited();
    }
    make_zero(drops_, is_input_lost_ ? no_limits_ : limits_);
    fall_from_limits();
  }
}

// Ramps

/// Begin to fall from the command being executed, or go on from where the fields are.
void Gate::start_ramps()
{
  if (is_executing_ || (stop_ == nullptr && is_falling_)) {
    begin_fall();
    has_fallen_ = true;
    fell_.assign(fell_.size(), 0.0);
    falls_since_.assign(falls_since_.size(), now_);
    return;
  }
  find_drops(now_);
  fell_ = drops_;
  for (std::int64_t & since : falls_since_) {
    since = std::max(since, now_);  // what a late call has published holds at its end
  }
}

/// Let the fields that a limit decides fall from what was published, once it decides no more.
void Gate::fall_from_limits()
{
  for (std::size_t field = 0; field < limits_.size(); ++field) {
    if (has_fallen_ && limits_[field] != nullptr) {
      fall_on(field);
      if (!fall_from_published(field, limits_[field])) {
        fell_[field] = ALL_THE_WAY;
      }
    }
  }
}

/// Let the fields with a limit in force be zero at once: without an input, they have no command.
void Gate::stop_limited()
{
  for (std::size_t field = 0; field < drops_.size(); ++field) {
    if (limits_[field] != nullptr) {
      drops_[field] = ALL_THE_WAY;
    }
  }
}

void Gate::fall_on(std::size_t field)
{
  fell_[field] = 0.0;
  falls_since_[field] = called_;
}

/// Find how far each field has fallen by t at the most; without a ramp, all the way.
void Gate::find_drops(std::int64_t t)
{
  drops_.assign(drops_.size(), ALL_THE_WAY);
  if (stop_ == nullptr) {
    return;
  }
  for (const Ramp & ramp : stop_->ramps) {
    const std::size_t field = place_of(ramp.field, table_.fields);
    const std::int64_t falls = std::max<std::int64_t>(t - falls_since_[field], 0);
    drops_[field] = fell_[field] + ramp.rate * static_cast<double>(falls) / 1e9;
  }
}

// Reports

void Gate::report(bool is_stopped)
{
  reported_.clear();
  for (std::size_t line = 0; line < table_.lines.size(); ++line) {
    const bool waits = is_held_ && table_.lines[line].effect.wait_ns != 0;
    reported_.push_back(applies_[line] || waits);
  }
  for (std::size_t line = 0; line < table_.lines.size(); ++line) {
    if (table_.lines[line].effect.until_reset) {
      reported_.push_back(latched_[line] && !applies_[line]);
    }
  }
  if (table_.waits_for_zero()) {
    reported_.push_back(is_waiting() && !is_stopped);
  }
  for (std::size_t input = 0; input < table_.inputs.size(); ++input) {
    reported_.push_back(standing_.is_unknown(input));
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
  if (table_.waits_for_zero()) {
    texts.emplace_back("waits for a zero command");
  }
  for (const Input & input : table_.inputs) {
    texts.push_back("input " + std::string(input.name) + " is unknown, so its bounds are 0");
  }
  return texts;
}

}  // namespace deros_runtime_cpp
