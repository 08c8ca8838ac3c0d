#include "deros_runtime/runtime/agenda.hpp"

#include <time.h>

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <functional>
#include <limits>
#include <mutex>
#include <utility>

namespace deros_runtime
{

namespace
{

constexpr Time PATIENCE = 50'000'000;  // ns that an alarm may be put off in all
constexpr Time NEVER = std::numeric_limits<Time>::max();

}  // namespace

Time steady_now()
{
  timespec now{};
  ::clock_gettime(CLOCK_MONOTONIC, &now);
  return static_cast<Time>(now.tv_sec) * 1'000'000'000 + now.tv_nsec;
}

std::size_t Agenda::add_source(std::function<void()> take, std::size_t capacity)
{
  const std::lock_guard<std::mutex> lock(mutex_);
  sources_.push_back({std::move(take), capacity, 0});
  queue_.resize(queue_.size() + capacity);
  return sources_.size() - 1;
}

void Agenda::notify(std::size_t source, std::size_t count)
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
  came_.notify_one();
}

void Agenda::end()
{
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    ends_ = true;
  }
  came_.notify_one();
}

void Agenda::run()
{
  while (true) {
    const std::size_t source = next_source();
    if (source != NOTHING) {
      sources_[source].take();
    }
    {
      const std::lock_guard<std::mutex> lock(mutex_);
      if (ends_) {
        return;
      }
    }
    ring_alarms();
  }
}

/// Wait until there is something to do; return the source whose turn it is, if it is one's.
std::size_t Agenda::next_source()
{
  const Times next = next_times();
  std::unique_lock<std::mutex> lock(mutex_);
  const auto is_awaited = [this] {return count_ > 0 || ends_;};
  if (next.wake == NEVER) {
    came_.wait(lock, is_awaited);
  } else {
    using Instant = std::chrono::steady_clock::time_point;
    came_.wait_until(lock, Instant(std::chrono::nanoseconds(next.wake)), is_awaited);
    lock.unlock();
    while (!is_awaited() && steady_now() < next.ring) {
      // A thread that sleeps wakes up late: the last moments are spent awake.
    }
    lock.lock();
  }
  if (count_ == 0 || ends_) {
    return NOTHING;
  }
  const std::size_t source = queue_[first_];
  first_ = (first_ + 1) % queue_.size();
  --count_;
  --sources_[source].waiting;
  return source;
}

/// Return when the next alarm rings that waits for steady time, and when to wake up for it.
Agenda::Times Agenda::next_times() const
{
  Times next{NEVER, NEVER};
  for (const Alarm * alarm : alarms_) {
    if (alarm->is_set_ && alarm->clock_.is_steady) {
      next.ring = std::min(next.ring, alarm->wait_until_);
      next.wake = std::min(next.wake, alarm->wait_until_ - alarm->lead_);
    }
  }
  return next;
}

void Agenda::ring_alarms()
{
  for (Alarm * alarm : alarms_) {
    alarm->ring_if_due();
  }
}

Alarm::Alarm(
  Agenda & agenda, Clock clock, std::function<void()> callback, std::function<Time()> put_off,
  Time lead)
: clock_(std::move(clock)), callback_(std::move(callback)), put_off_(std::move(put_off)),
  lead_(lead)
{
  agenda.alarms_.push_back(this);
}

void Alarm::ring_at(Time due)
{
  due_ = due;
  wait_until_ = due;
  is_set_ = true;
}

void Alarm::repeat(Time period)
{
  const Time now = clock_.now();
  const Time due = due_ + period;
  ring_at(now < due && due <= now + period ? due : now + period);
}

void Alarm::ring_if_due()
{
  if (!is_set_) {
    return;
  }
  const Time now = clock_.now();
  if (now < wait_until_) {
    return;
  }
  if (put_off_ && now - due_ < PATIENCE) {
    const Time pause = put_off_();
    if (pause > 0) {
      wait_until_ = now + pause;
      return;
    }
  }
  is_set_ = false;
  callback_();
}

}  // namespace deros_runtime
