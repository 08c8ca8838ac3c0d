#ifndef DEROS_RUNTIME__RUNTIME__AGENDA_HPP_
#define DEROS_RUNTIME__RUNTIME__AGENDA_HPP_

#include <atomic>
#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <mutex>
#include <vector>

namespace deros_runtime
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

class Alarm;

/// All that a thread has to do: what comes from outside, in order, and alarms.
/**
 * The thread that calls run() does it all. It waits on one condition, with the next alarm as the
 * limit, so that what comes wakes it directly. Nothing is allocated while it runs. Alarms of other
 * clocks than the steady one are looked at whenever it wakes, so their clock should be a source.
 */
class Agenda
{
public:
  Agenda() = default;
  Agenda(const Agenda &) = delete;
  Agenda & operator=(const Agenda &) = delete;

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
  friend class Alarm;

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
  void ring_alarms();

  std::vector<Source> sources_;
  std::vector<Alarm *> alarms_;

  std::mutex mutex_;
  std::condition_variable came_;
  std::vector<std::size_t> queue_;  // a ring of numbers of sources
  std::size_t first_ = 0;
  std::atomic<std::size_t> count_{0};  // changed under the mutex, as is the next
  std::atomic<bool> ends_{false};
};

/// Rings at an instant of a clock, once; belongs to the thread of its agenda.
class Alarm
{
public:
  /**
   * \param put_off tells of an alarm that is not urgent for how long something else goes before it
   * \param lead for how long before it rings the thread stays awake, so that it rings on the dot
   */
  Alarm(
    Agenda & agenda, Clock clock, std::function<void()> callback,
    std::function<Time()> put_off = {}, Time lead = 0);
  Alarm(const Alarm &) = delete;
  Alarm & operator=(const Alarm &) = delete;

  /// Tell whether it is going to ring, and return for when it is set, or was last.
  bool is_set() const
  {
    return is_set_;
  }
  Time due() const
  {
    return due_;
  }

  /// Ring at an instant, or at once if it is past; what was set before is forgotten.
  void ring_at(Time due);

  /// Ring again a period after the last time, or after now if either was long ago.
  void repeat(Time period);

  /// Do not ring.
  void cancel()
  {
    is_set_ = false;
  }

private:
  friend class Agenda;

  void ring_if_due();

  Clock clock_;
  std::function<void()> callback_;
  std::function<Time()> put_off_;
  Time lead_;
  Time due_ = 0;
  Time wait_until_ = 0;
  bool is_set_ = false;
};

}  // namespace deros_runtime

#endif  // DEROS_RUNTIME__RUNTIME__AGENDA_HPP_
