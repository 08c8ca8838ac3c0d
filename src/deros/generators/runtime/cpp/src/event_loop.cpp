// Copyright and licence: see package.xml.

#include "deros_runtime_cpp/event_loop.hpp"

#include <time.h>

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <functional>
#include <limits>
#include <mutex>
#include <utility>

namespace deros_runtime_cpp
{

namespace
{

constexpr Time MAX_DEFERRAL = 50'000'000;  // ns for which a timer may be deferred in all
constexpr Time NEVER = std::numeric_limits<Time>::max();

}  // namespace

Time steady_now()
{
  timespec now{};
  ::clock_gettime(CLOCK_MONOTONIC, &now);
  return static_cast<Time>(now.tv_sec) * 1'000'000'000 + now.tv_nsec;
}

std::size_t EventLoop::add_source(std::function<void()> take, std::size_t capacity)
{
  const std::lock_guard<std::mutex> lock(mutex_);
  sources_.push_back({std::move(take), capacity, 0});
  queue_.resize(queue_.size() + capacity);
  return sources_.size() - 1;
}

void EventLoop::notify(std::size_t source, std::size_t count)
{
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    Source & from = sources_[source];
    for (; count > 0 && from.waiting < from.capacity; --count) {
      ++from.waiting;
      queue_[(first_ + count_) % queue_.size()] = source;
      ++count_;
    }
  }
  wake_up_.notify_one();
}

void EventLoop::stop()
{
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    is_stopping_ = true;
  }
  wake_up_.notify_one();
}

void EventLoop::run()
{
  while (true) {
    const std::size_t source = next_source();
    if (source != NO_SOURCE) {
      sources_[source].take();
    }
    {
      const std::lock_guard<std::mutex> lock(mutex_);
      if (is_stopping_) {
        return;
      }
    }
    fire_timers();
  }
}

/// Wait for an item, a timer or stop(); return the source of the item, if there is one.
std::size_t EventLoop::next_source()
{
  const Times next = next_times();
  std::unique_lock<std::mutex> lock(mutex_);
  const auto has_work = [this] {return count_ > 0 || is_stopping_;};
  if (next.wake == NEVER) {
    wake_up_.wait(lock, has_work);
  } else {
    using Instant = std::chrono::steady_clock::time_point;
    wake_up_.wait_until(lock, Instant(std::chrono::nanoseconds(next.wake)), has_work);
    lock.unlock();
    while (!has_work() && steady_now() < next.fire) {
      // A sleeping thread wakes up late, so it spins for the last moments.
    }
    lock.lock();
  }
  if (count_ == 0 || is_stopping_) {
    return NO_SOURCE;
  }
  const std::size_t source = queue_[first_];
  first_ = (first_ + 1) % queue_.size();
  --count_;
  --sources_[source].waiting;
  return source;
}

/// Return when the next timer on the steady clock expires, and when to wake up for it.
EventLoop::Times EventLoop::next_times() const
{
  Times next{NEVER, NEVER};
  for (const OneShotTimer * timer : timers_) {
    if (timer->is_scheduled_ && timer->clock_.is_steady) {
      next.fire = std::min(next.fire, timer->wait_until_);
      next.wake = std::min(next.wake, timer->wait_until_ - timer->lead_);
    }
  }
  return next;
}

void EventLoop::fire_timers()
{
  for (OneShotTimer * timer : timers_) {
    timer->fire_if_due();
  }
}

OneShotTimer::OneShotTimer(
  EventLoop & event_loop, Clock clock, std::function<void()> callback, std::function<Time()> defer,
  Time lead)
: clock_(std::move(clock)), callback_(std::move(callback)), defer_(std::move(defer)),
  lead_(lead)
{
  event_loop.timers_.push_back(this);
}

void OneShotTimer::schedule(Time due)
{
  due_ = due;
  wait_until_ = due;
  is_scheduled_ = true;
}

void OneShotTimer::repeat(Time period)
{
  const Time now = clock_.now();
  const Time due = due_ + period;
  schedule(now < due && due <= now + period ? due : now + period);
}

void OneShotTimer::fire_if_due()
{
  if (!is_scheduled_) {
    return;
  }
  const Time now = clock_.now();
  if (now < wait_until_) {
    return;
  }
  if (defer_ && now - due_ < MAX_DEFERRAL) {
    const Time deferral = defer_();
    if (deferral > 0) {
      wait_until_ = now + deferral;
      return;
    }
  }
  is_scheduled_ = false;
  callback_();
}

}  // namespace deros_runtime_cpp
