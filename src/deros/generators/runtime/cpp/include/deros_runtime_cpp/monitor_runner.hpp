// Copyright and licence: see package.xml.

#ifndef DEROS_RUNTIME_CPP__MONITOR_RUNNER_HPP_
#define DEROS_RUNTIME_CPP__MONITOR_RUNNER_HPP_

#include <cstddef>
#include <exception>
#include <functional>
#include <vector>

#include "deros_runtime_cpp/event_loop.hpp"
#include "deros_runtime_cpp/report_types.hpp"

namespace deros_runtime_cpp
{

/// A monitor, and those who do what it orders.
class MonitorHost
{
public:
  virtual ~MonitorHost() = default;

  /// Have the monitor start at an instant; again when simulated time begins.
  virtual void begin(Time start) = 0;

  /// Have the monitor settle all that is due up to and including an instant.
  virtual void advance(Time now) = 0;

  /// Return when advance() has to be called at the latest; greatest of all times for never.
  virtual Time due() const = 0;

  /// Publish and mark as pending what an event asks for, in the middle of an evaluation.
  /** \return whether no robot code is left to be run */
  virtual bool show(const Event & event) = 0;

  /// Run the robot code that an event asks for.
  virtual void run_code(const Event & event) = 0;

  /// Remember what the monitor is worth now, for the report of the events of this instant.
  /** \param count how many there are since after(), with those of the instants before */
  virtual void remember(std::size_t count) = 0;

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
 * messages to the monitor, with the time of catch_up(), and calls settle() then.
 */
class MonitorRunner
{
public:
  MonitorRunner(EventLoop & event_loop, Clock clock, MonitorHost & watched);

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

  /// Settle what is due before anything else, and return the time that it is now.
  /** Each instant is settled by itself: its events are explained by what was known then. */
  Time catch_up();

  /// Take an event while the monitor evaluates: show at once what it asks for.
  /** Robot code waits until all events are shown, whatever their order. */
  void take(const Event & event) noexcept;

  /// Do the rest of what the monitor ordered, and wake up for its next deadline.
  void settle();

  /// Run the robot code of actions that were active before the start, of each of them.
  void run_again(const std::vector<Event> & events);

  /// Settle all that is due, and return the time that it is now.
  Time advance();

  /// Return for how long what can wait has to, as a deadline is near.
  Time defer() const;

  /// Start when simulated time begins, and settle a step back without waiting.
  void clock_changed(bool back);

private:
  using Indices = std::vector<std::size_t>;
  using Act = std::function<void (const Event &)>;

  void carry_out();
  void remember();
  void attempt(const Act & act, const Event & event);
  void fail_if_something_failed();
  void arm();

  Clock clock_;
  MonitorHost & host_;
  Time began_at_ = 0;
  bool has_started_ = false;
  std::vector<Event> events_;  // of this evaluation, in the monitor's order
  std::vector<Time> done_;  // when each of these was done
  Indices unpublished_;  // the indices of those that could not be shown
  Indices code_;  // the indices of those whose code is still to be run
  std::size_t remembered_ = 0;  // how many of them can be explained
  std::exception_ptr failure_;  // the first one
  OneShotTimer deadline_;
};

}  // namespace deros_runtime_cpp

#endif  // DEROS_RUNTIME_CPP__MONITOR_RUNNER_HPP_
