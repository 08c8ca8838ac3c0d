// Copyright and licence: see package.xml.

#include "deros_runtime_cpp/monitor_runner.hpp"

#include <cstddef>
#include <exception>
#include <limits>
#include <utility>

namespace deros_runtime_cpp
{

namespace
{

constexpr Time NEVER = std::numeric_limits<Time>::max();
constexpr Time NEAR = 2'000'000;  // ns before a deadline in which no deferrable work begins
constexpr Time AFTER = 1'000'000;  // ns after it for the execution of what it orders
constexpr Time LEAD = 200'000;  // ns before it in which the thread spins: few wake-ups are later
constexpr std::size_t EVENTS = 1024;  // of one evaluation, for which memory is reserved

}  // namespace

MonitorRunner::MonitorRunner(EventLoop & event_loop, Clock clock, MonitorHost & host)
: clock_(std::move(clock)),
  host_(host),
  deadline_(event_loop, clock_, [this] {advance();}, {}, LEAD)
{
  events_.reserve(EVENTS);
  done_.reserve(EVENTS);
  unpublished_.reserve(EVENTS);
  code_.reserve(EVENTS);
}

void MonitorRunner::start()
{
  host_.begin(now());
  schedule_deadline();
}

Time MonitorRunner::catch_up()
{
  const Time t = now();
  for (Time due = host_.next_deadline(); due <= t; due = host_.next_deadline()) {
    host_.advance(due);
    save_snapshot();
  }
  return t;
}

void MonitorRunner::take(const Event & event) noexcept
{
  Indices * pending = nullptr;
  try {
    pending = host_.show(event) ? nullptr : &code_;
  } catch (...) {
    pending = &unpublished_;  // tried again, and reported, when the monitor has evaluated
  }
  if (pending != nullptr) {
    pending->push_back(events_.size());
  }
  done_.push_back(now());
  events_.push_back(event);
}

void MonitorRunner::settle()
{
  if (!events_.empty()) {
    save_snapshot();
    execute();
  }
  schedule_deadline();
}

void MonitorRunner::run_again(const std::vector<Event> & events)
{
  for (const Event & event : events) {
    attempt([this](const Event & each) {host_.run_code(each);}, event);
  }
  rethrow_failure();
}

Time MonitorRunner::advance()
{
  const Time t = catch_up();
  host_.advance(t);
  settle();
  return t;
}

Time MonitorRunner::defer() const
{
  const Time due = host_.next_deadline();
  if (due == NEVER || !clock_.is_steady) {
    return 0;
  }
  const Time left = due - now();
  return left < NEAR ? left + AFTER : 0;
}

void MonitorRunner::clock_changed(bool stepped)
{
  if (stepped) {
    advance();
    host_.clock_stepped();
  }
}

/// Execute all that is left, and only then rethrow the first failure.
void MonitorRunner::execute()
{
  for (const std::size_t i : unpublished_) {
    attempt([this](const Event & event) {host_.show(event);}, events_[i]);
    done_[i] = now();
  }
  for (const std::size_t i : code_) {
    attempt([this](const Event & event) {host_.run_code(event);}, events_[i]);
    done_[i] = now();
  }
  unpublished_.clear();
  code_.clear();
  host_.after(events_, done_);
  events_.clear();
  done_.clear();
  explained_ = 0;
  rethrow_failure();
}

/// Save a snapshot for the events of the last instant, if there are any.
void MonitorRunner::save_snapshot()
{
  if (events_.size() > explained_) {
    host_.save_snapshot(events_.size());
    explained_ = events_.size();
  }
}

/// Call a function; report and store what it throws.
void MonitorRunner::attempt(const Act & act, const Event & event)
{
  try {
    act(event);
  } catch (const std::exception & error) {
    failure_ = failure_ ? failure_ : std::current_exception();
    host_.report_failure(event, error.what());
  } catch (...) {
    failure_ = failure_ ? failure_ : std::current_exception();
    host_.report_failure(event, "it threw something that is not a std::exception");
  }
}

/// Rethrow the stored failure, if there is one: it ends the node and its heartbeat.
void MonitorRunner::rethrow_failure()
{
  if (failure_) {
    host_.flush_reports();
    std::rethrow_exception(failure_);
  }
}

/// Schedule the next deadline of the monitor, unless the timer expires earlier.
void MonitorRunner::schedule_deadline()
{
  const Time due = host_.next_deadline();
  if (due != NEVER && !(deadline_.is_scheduled() && deadline_.due() <= due)) {
    deadline_.schedule(due);
  }
}

}  // namespace deros_runtime_cpp
