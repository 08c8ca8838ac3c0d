// Copyright and licence: see package.xml.

#ifndef DEROS_RUNTIME_CPP__EVENT_LOOP_HPP_
#define DEROS_RUNTIME_CPP__EVENT_LOOP_HPP_

#include <atomic>
#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <mutex>
#include <vector>

namespace deros_runtime_cpp
{

/// A point in time or a duration, in nanoseconds.
using Time = std::int64_t;

/// Return the time of the steady clock, which nobody can set.
Time steady_now();

/// A clock: the function that reads it, and whether it is the steady clock.
struct Clock
{
  std::function<Time()> now = steady_now;
  bool is_steady = true;
  std::function<Time()> origin = [] {return Time(0);};  // what reports add to its times
};

class OneShotTimer;

/// Runs the work of one thread: items from sources, in order of arrival, and timers.
/**
 * The thread that calls run() does all the work. It waits on one condition variable until an item
 * arrives or the next timer expires, so that an item wakes it directly. Nothing is allocated while
 * it runs. Timers of clocks other than the steady clock are checked whenever the thread wakes up,
 * so such a clock should be a source.
 */
class EventLoop
{
public:
  EventLoop() = default;
  EventLoop(const EventLoop &) = delete;
  EventLoop & operator=(const EventLoop &) = delete;

  /// Add a source of items, one of which take() processes. To be called before run().
  /**
   * \param capacity how many items of this source can wait; further ones are dropped
   * \return the number of the source
   */
  std::size_t add_source(std::function<void()> take, std::size_t capacity);

  /// Announce items of a source; from any thread.
  void notify(std::size_t source, std::size_t count = 1);

  /// Process items and timers until stop() is called or one of them throws.
  void run();

  /// Stop soon, without processing what waits; from any thread.
  void stop();

private:
  friend class OneShotTimer;

  struct Source
  {
    std::function<void()> take;
    std::size_t capacity;
    std::size_t waiting;
  };

  static constexpr std::size_t NO_SOURCE = static_cast<std::size_t>(-1);

  struct Times
  {
    Time wake;
    Time fire;
  };

  std::size_t next_source();
  Times next_times() const;
  void fire_timers();

  std::vector<Source> sources_;
  std::vector<OneShotTimer *> timers_;

  std::mutex mutex_;
  std::condition_variable wake_up_;
  std::vector<std::size_t> queue_;  // a ring buffer of the numbers of sources
  std::size_t first_ = 0;
  std::atomic<std::size_t> count_{0};  // changed under the mutex, like the next one
  std::atomic<bool> is_stopping_{false};
};

/// Calls a function once, at a point in time, in the thread of its event loop.
class OneShotTimer
{
public:
  /**
   * \param defer returns for how long a timer that is not urgent has to wait for something else
   * \param lead for how long before it expires the thread spins instead of sleeping, to be on time
   */
  OneShotTimer(
    EventLoop & event_loop, Clock clock, std::function<void()> callback,
    std::function<Time()> defer = {}, Time lead = 0);
  OneShotTimer(const OneShotTimer &) = delete;
  OneShotTimer & operator=(const OneShotTimer &) = delete;

  /// Return whether the timer is scheduled.
  bool is_scheduled() const
  {
    return is_scheduled_;
  }

  /// Return the time that the timer is scheduled for, or was last.
  Time due() const
  {
    return due_;
  }

  /// Expire at a time, or at once if it is past; this replaces an earlier schedule.
  void schedule(Time due);

  /// Expire a period after the last time, or after now if either was long ago.
  void repeat(Time period);

  /// Do not expire.
  void cancel()
  {
    is_scheduled_ = false;
  }

private:
  friend class EventLoop;

  void fire_if_due();

  Clock clock_;
  std::function<void()> callback_;
  std::function<Time()> defer_;
  Time lead_;
  Time due_ = 0;
  Time wait_until_ = 0;
  bool is_scheduled_ = false;
};

}  // namespace deros_runtime_cpp

#endif  // DEROS_RUNTIME_CPP__EVENT_LOOP_HPP_
