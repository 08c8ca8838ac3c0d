#ifndef DEROS_RUNTIME__RUNTIME__WATCH_HPP_
#define DEROS_RUNTIME__RUNTIME__WATCH_HPP_

#include <cstddef>
#include <vector>

#include "deros_runtime/runtime/agenda.hpp"
#include "deros_runtime/runtime/told.hpp"

namespace deros_runtime
{

/// A monitor, and those who do what it orders.
class Watched
{
public:
  virtual ~Watched() = default;

  /// Have the monitor start at an instant; again when simulated time begins.
  virtual void begin(Time start) = 0;

  /// Have the monitor settle all that is due up to and including an instant.
  virtual void advance(Time now) = 0;

  /// Return when advance() has to be called at the latest; greatest of all times for never.
  virtual Time due() const = 0;

  /// Do what an event asks for if that takes no time, in the middle of an evaluation.
  /** \return whether nothing else is to be done */
  virtual bool show(const Event & event) = 0;

  /// Do what an event asks for.
  virtual void act(const Event & event) = 0;

  /// Take the events that have been dealt with, and when each of them was done.
  virtual void after(const std::vector<Event> & events, const std::vector<Time> & done) = 0;

  /// Tell of what was done, before the failure of an action ends the node.
  virtual void tell() = 0;

  /// Tell that an action failed.
  virtual void tell_failure(const Event & event, const char * why) = 0;

  /// Act on a beginning of simulated time, or a step back of it.
  virtual void stepped() = 0;
};

/// A monitor in time: it is told what time it is, and what it orders is done at once.
/**
 * It runs on steady time, which never steps, or on ROS time under use_sim_time. The owner hands
 * messages to the monitor, with the time of now(), and calls settle() then.
 */
class Watch
{
public:
  Watch(Agenda & agenda, Clock clock, Watched & watched);

  /// Return the time that the monitor is told.
  Time now() const
  {
    return clock_.now();
  }

  /// Return when the monitor began; 0 if simulated time has not begun yet.
  Time began_at() const
  {
    return began_at_;
  }

  /// Start the monitor: its timeouts count from now.
  void start();

  /// Take an event while the monitor evaluates: show at once what it asks for.
  /** Others before it that are still to be done go first. */
  void take(const Event & event) noexcept;

  /// Do what the monitor ordered, in order, and wake up for its next deadline.
  void settle();

  /// Settle all that is due, and return the time that it is now.
  Time advance();

  /// Return for how long what can wait has to, as a deadline is near.
  Time put_off() const;

  /// Start when simulated time begins, and settle a step back without waiting.
  void clock_changed(bool back);

private:
  void carry_out();
  void arm();

  Clock clock_;
  Watched & watched_;
  Time began_at_ = 0;
  bool has_started_ = false;
  std::vector<Event> ordered_;  // and not done yet
  std::vector<Event> dealt_with_;
  std::vector<Time> done_;  // when each of these was done
  Alarm deadline_;
};

}  // namespace deros_runtime

#endif  // DEROS_RUNTIME__RUNTIME__WATCH_HPP_
