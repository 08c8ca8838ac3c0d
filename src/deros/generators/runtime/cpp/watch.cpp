#include "deros_runtime/runtime/watch.hpp"

#include <cstddef>
#include <exception>
#include <limits>
#include <utility>

namespace deros_runtime
{

namespace
{

constexpr Time NEVER = std::numeric_limits<Time>::max();
constexpr Time NEAR = 2'000'000;  // ns before a deadline in which nothing is begun that can wait
constexpr Time AFTER = 1'000'000;  // ns after it in which what it orders is done
constexpr Time LEAD = 200'000;  // ns before it in which its thread is awake: few wake up later
constexpr std::size_t EVENTS = 1024;  // of one evaluation, for which there is room from the start

}  // namespace

Watch::Watch(Agenda & agenda, Clock clock, Watched & watched)
: clock_(std::move(clock)),
  watched_(watched),
  deadline_(agenda, clock_, [this] {advance();}, {}, LEAD)
{
  events_.reserve(EVENTS);
  done_.reserve(EVENTS);
  unpublished_.reserve(EVENTS);
  code_.reserve(EVENTS);
}

void Watch::start()
{
  has_started_ = true;
  began_at_ = now();
  watched_.begin(began_at_);
  deadline_.cancel();
  arm();
}

Time Watch::catch_up()
{
  const Time t = now();
  for (Time due = watched_.due(); due <= t; due = watched_.due()) {
    watched_.advance(due);
    remember();
  }
  return t;
}

void Watch::take(const Event & event) noexcept
{
  Indices * left = nullptr;
  try {
    left = watched_.show(event) ? nullptr : &code_;
  } catch (...) {
    left = &unpublished_;  // it is tried again, and reported, when the monitor is through
  }
  if (left != nullptr) {
    left->push_back(events_.size());
  }
  done_.push_back(now());
  events_.push_back(event);
}

void Watch::settle()
{
  if (!events_.empty()) {
    remember();
    carry_out();
  }
  arm();
}

void Watch::run_again(const std::vector<Event> & events)
{
  for (const Event & event : events) {
    attempt([this](const Event & each) {watched_.run_code(each);}, event);
  }
  fail_if_something_failed();
}

Time Watch::advance()
{
  const Time t = catch_up();
  watched_.advance(t);
  settle();
  return t;
}

Time Watch::put_off() const
{
  const Time due = watched_.due();
  if (due == NEVER || !clock_.is_steady) {
    return 0;
  }
  const Time left = due - now();
  return left < NEAR ? left + AFTER : 0;
}

void Watch::clock_changed(bool back)
{
  const bool begins = has_started_ && began_at_ == 0;
  if (begins) {
    start();
  }
  if (begins || back) {
    watched_.stepped();
    advance();
  }
}

/// Do all that is left of what was ordered, and only then fail if something failed.
void Watch::carry_out()
{
  for (const std::size_t i : unpublished_) {
    attempt([this](const Event & event) {watched_.show(event);}, events_[i]);
    done_[i] = now();
  }
  for (const std::size_t i : code_) {
    attempt([this](const Event & event) {watched_.run_code(event);}, events_[i]);
    done_[i] = now();
  }
  unpublished_.clear();
  code_.clear();
  watched_.after(events_, done_);
  events_.clear();
  done_.clear();
  remembered_ = 0;
  fail_if_something_failed();
}

/// Remember what explains the events of the last instant, if there are any.
void Watch::remember()
{
  if (events_.size() > remembered_) {
    watched_.remember(events_.size());
    remembered_ = events_.size();
  }
}

/// Do something; tell and note what it throws.
void Watch::attempt(const Act & act, const Event & event)
{
  try {
    act(event);
  } catch (const std::exception & error) {
    failure_ = failure_ ? failure_ : std::current_exception();
    watched_.tell_failure(event, error.what());
  } catch (...) {
    failure_ = failure_ ? failure_ : std::current_exception();
    watched_.tell_failure(event, "what it threw says nothing of itself");
  }
}

/// End the node, and its heartbeat with it, if something was thrown.
void Watch::fail_if_something_failed()
{
  if (failure_) {
    watched_.tell();
    std::rethrow_exception(failure_);
  }
}

/// Set the alarm to the monitor's next deadline; one that rings earlier may stay.
void Watch::arm()
{
  const Time due = watched_.due();
  if (due != NEVER && !(deadline_.is_set() && deadline_.due() <= due)) {
    deadline_.ring_at(due);
  }
}

}  // namespace deros_runtime
