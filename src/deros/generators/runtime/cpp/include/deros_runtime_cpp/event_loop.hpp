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

/// An instant, or a time between two, in nanoseconds.
using Time = std::int64_t;

/// Return what the clock shows that nobody can set.
Time steady_now();

/// A clock: what it shows, and whether it is the steady one.
struct Clock
{
  std::function<Time()> now = steady_now;
  bool is_steady = true;
};

class OneShotTimer;

/// All that a thread has to do: what comes from outside, in order, and timers.
/**
 * The thread that calls run() does it all. It waits on one condition, with the next timer as the
 * limit, so that what comes wakes it directly. Nothing is allocated while it runs. Alarms of other
 * clocks than the steady one are looked at whenever it wakes, so their clock should be a source.
 */
class EventLoop
{
public:
  EventLoop() = default;
  EventLoop(const EventLoop &) = delete;
  EventLoop & operator=(const EventLoop &) = delete;

  /// Add a source of things to do; take() does one of them. To be called before run().
  /**
   * \param capacity how many of them can wait; what comes then is forgotten
   * \return the number of the source
   */
  std::size_t add_source(std::function<void()> take, std::size_t capacity);

  /// Note that a source has so many more things to do; from any thread.
  void notify(std::size_t source, std::size_t count = 1);

  /// Do what there is to do until end(); what is thrown in the course of it ends it, too.
  void run();

  /// End soon, without doing what is left; from any thread.
  void end();

private:
  friend class OneShotTimer;

  struct Source
  {
    std::function<void()> take;
    std::size_t capacity;
    std::size_t waiting;
  };

  static constexpr std::size_t NOTHING = static_cast<std::size_t>(-1);

  struct Times
  {
    Time wake;
    Time ring;
  };

  std::size_t next_source();
  Times next_times() const;
  void fire_timers();

  std::vector<Source> sources_;
  std::vector<OneShotTimer *> timers_;

  std::mutex mutex_;
  std::condition_variable came_;
  std::vector<std::size_t> queue_;  // a ring of numbers of sources
  std::size_t first_ = 0;
  std::atomic<std::size_t> count_{0};  // changed under the mutex, as is the next
  std::atomic<bool> ends_{false};
};

/// Rings at an instant of a clock, once; belongs to the thread of its event loop.
class OneShotTimer
{
public:
  /**
   * \param defer tells of an timer that is not urgent for how long something else goes before it
   * \param lead for how long before it rings the thread stays awake, so that it rings on the dot
   */
  OneShotTimer(
    EventLoop & event_loop, Clock clock, std::function<void()> callback,
    std::function<Time()> defer = {}, Time lead = 0);
  OneShotTimer(const OneShotTimer &) = delete;
  OneShotTimer & operator=(const OneShotTimer &) = delete;

  /// Tell whether it is going to ring, and return for when it is set, or was last.
  bool is_scheduled() const
  {
    return is_scheduled_;
  }
  Time due() const
  {
    return due_;
  }

  /// Ring at an instant, or at once if it is past; what was set before is forgotten.
  void schedule(Time due);

  /// Ring again a period after the last time, or after now if either was long ago.
  void repeat(Time period);

  /// Do not ring.
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
