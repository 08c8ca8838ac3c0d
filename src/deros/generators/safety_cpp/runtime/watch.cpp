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
  ordered_.reserve(EVENTS);
  dealt_with_.reserve(EVENTS);
  done_.reserve(EVENTS);
}

void Watch::start()
{
  has_started_ = true;
  began_at_ = now();
  watched_.begin(began_at_);
  deadline_.cancel();
  arm();
}

void Watch::take(const Event & event) noexcept
{
  bool is_shown = false;
  try {
    is_shown = ordered_.empty() && watched_.show(event);
  } catch (const std::exception &) {
    is_shown = false;  // it is tried again, and reported, when the monitor is through
  }
  if (is_shown) {
    done_.push_back(now());
    dealt_with_.push_back(event);
  } else {
    ordered_.push_back(event);
  }
}

void Watch::settle()
{
  if (!ordered_.empty() || !done_.empty()) {
    carry_out();
  }
  arm();
}

Time Watch::advance()
{
  const Time t = now();
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
  std::exception_ptr failure;
  for (const Event & event : ordered_) {
    try {
      watched_.act(event);
    } catch (const std::exception & error) {
      watched_.tell_failure(event, error.what());
      failure = failure ? failure : std::current_exception();
    } catch (...) {
      watched_.tell_failure(event, "what it threw says nothing of itself");
      failure = failure ? failure : std::current_exception();
    }
    done_.push_back(now());
    dealt_with_.push_back(event);
  }
  ordered_.clear();
  watched_.after(dealt_with_, done_);
  dealt_with_.clear();
  done_.clear();
  if (failure) {
    watched_.tell();
    std::rethrow_exception(failure);  // the heartbeat stops with the node
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
