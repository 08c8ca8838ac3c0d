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
constexpr Time NEAR = 2'000'000;  // ns before a deadline in which nothing is begun that can wait
constexpr Time AFTER = 1'000'000;  // ns after it in which what it orders is done
constexpr Time LEAD = 200'000;  // ns before it in which its thread is awake: few wake up later
constexpr std::size_t EVENTS = 1024;  // of one evaluation, for which there is room from the start

}  // namespace

MonitorRunner::MonitorRunner(EventLoop & event_loop, Clock clock, MonitorHost & watched)
: clock_(std::move(clock)),
  host_(watched),
  deadline_(event_loop, clock_, [this] {advance();}, {}, LEAD)
{
  events_.reserve(EVENTS);
  done_.reserve(EVENTS);
  unpublished_.reserve(EVENTS);
  code_.reserve(EVENTS);
}

void MonitorRunner::start()
{
  has_started_ = true;
  began_at_ = now();
  host_.begin(began_at_);
  deadline_.cancel();
  arm();
}

Time MonitorRunner::catch_up()
{
  const Time t = now();
  for (Time due = host_.due(); due <= t; due = host_.due()) {
    host_.advance(due);
    remember();
  }
  return t;
}

void MonitorRunner::take(const Event & event) noexcept
{
  Indices * left = nullptr;
  try {
    left = host_.show(event) ? nullptr : &code_;
  } catch (...) {
    left = &unpublished_;  // it is tried again, and reported, when the monitor is through
  }
  if (left != nullptr) {
    left->push_back(events_.size());
  }
  done_.push_back(now());
  events_.push_back(event);
}

void MonitorRunner::settle()
{
  if (!events_.empty()) {
    remember();
    carry_out();
  }
  arm();
}

void MonitorRunner::run_again(const std::vector<Event> & events)
{
  for (const Event & event : events) {
    attempt([this](const Event & each) {host_.run_code(each);}, event);
  }
  fail_if_something_failed();
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
  const Time due = host_.due();
  if (due == NEVER || !clock_.is_steady) {
    return 0;
  }
  const Time left = due - now();
  return left < NEAR ? left + AFTER : 0;
}

void MonitorRunner::clock_changed(bool back)
{
  const bool begins = has_started_ && began_at_ == 0;
  if (begins) {
    start();
  }
  if (begins || back) {
    host_.stepped();
    advance();
  }
}

/// Do all that is left of what was ordered, and only then fail if something failed.
void MonitorRunner::carry_out()
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
  remembered_ = 0;
  fail_if_something_failed();
}

/// Remember what explains the events of the last instant, if there are any.
void MonitorRunner::remember()
{
  if (events_.size() > remembered_) {
    host_.remember(events_.size());
    remembered_ = events_.size();
  }
}

/// Do something; tell and note what it throws.
void MonitorRunner::attempt(const Act & act, const Event & event)
{
  try {
    act(event);
  } catch (const std::exception & error) {
    failure_ = failure_ ? failure_ : std::current_exception();
    host_.tell_failure(event, error.what());
  } catch (...) {
    failure_ = failure_ ? failure_ : std::current_exception();
    host_.tell_failure(event, "what it threw says nothing of itself");
  }
}

/// End the node, and its heartbeat with it, if something was thrown.
void MonitorRunner::fail_if_something_failed()
{
  if (failure_) {
    host_.tell();
    std::rethrow_exception(failure_);
  }
}

/// Set the timer to the monitor's next deadline; one that rings earlier may stay.
void MonitorRunner::arm()
{
  const Time due = host_.due();
  if (due != NEVER && !(deadline_.is_scheduled() && deadline_.due() <= due)) {
    deadline_.schedule(due);
  }
}

}  // namespace deros_runtime_cpp
