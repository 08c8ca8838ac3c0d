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

/// A monitor, and the functions that execute what it orders.
class MonitorHost
{
public:
  virtual ~MonitorHost() = default;

  /// Start the monitor at a time.
  virtual void begin(Time start) = 0;

  /// Advance the monitor up to and including a time.
  virtual void advance(Time now) = 0;

  /// Return when advance() has to be called at the latest; the maximum for never.
  virtual Time next_deadline() const = 0;

  /// Publish the state that an event changes, while the monitor still evaluates.
  /** \return false if robot code has to run for the event */
  virtual bool show(const Event & event) = 0;

  /// Run the robot code of an event.
  virtual void run_code(const Event & event) = 0;

  /// Save a snapshot of the monitor, for the reports of the events of this instant.
  /** \param count the number of events since after(), those of earlier instants included */
  virtual void save_snapshot(std::size_t count) = 0;

  /// Take the events that have been executed, and the time when each of them was.
  virtual void after(const std::vector<Event> & events, const std::vector<Time> & done) = 0;

  /// Publish the queued reports, before the failure of an action ends the node.
  virtual void flush_reports() = 0;

  /// Report that an action failed.
  virtual void report_failure(const Event & event, const char * why) = 0;

  /// Called when simulated time has begun or stepped back, and that is evaluated.
  virtual void clock_stepped() = 0;
};

/// Drives a monitor from a clock, and executes what it orders at once.
/**
 * The clock is the steady clock, which never steps, or ROS time with use_sim_time. The owner passes
 * messages to the monitor with the time that catch_up() returns, and calls settle() afterwards.
 */
class MonitorRunner
{
public:
  MonitorRunner(EventLoop & event_loop, Clock clock, MonitorHost & host);

  /// Return the time of the monitor.
  Time now() const
  {
    return clock_.now();
  }

  /// Return what reports add to times of the monitor.
  Time origin() const
  {
    return clock_.origin();
  }

  /// Start the monitor: its timeouts count from now.
  void start();

  /// Advance the monitor to every deadline up to now, and return the time.
  /** One deadline at a time: its events are explained by what was known at that instant. */
  Time catch_up();

  /// Handle an event while the monitor evaluates: publish the state that it changes.
  /** Robot code runs only after all states have been published, whatever the order of events. */
  void take(const Event & event) noexcept;

  /// Execute the rest of what the monitor ordered, and schedule its next deadline.
  void settle();

  /// Run the robot code of actions that were active before the start.
  void run_again(const std::vector<Event> & events);

  /// Advance the monitor to the current time, execute what it orders, and return the time.
  Time advance();

  /// Return for how long work that is not urgent has to wait, because a deadline is near.
  Time defer() const;

  /// Advance in simulated time that has changed.
  /** \param stepped whether it has begun or stepped back */
  void clock_changed(bool stepped);

private:
  using Indices = std::vector<std::size_t>;
  using Act = std::function<void (const Event &)>;

  void execute();
  void save_snapshot();
  void attempt(const Act & act, const Event & event);
  void rethrow_failure();
  void schedule_deadline();

  Clock clock_;
  MonitorHost & host_;
  std::vector<Event> events_;  // of this evaluation, in the monitor's order
  std::vector<Time> done_;  // when each of them was executed
  Indices unpublished_;  // indices of those whose state could not be published
  Indices code_;  // indices of those whose code has not run yet
  std::size_t explained_ = 0;  // how many of them have a snapshot
  std::exception_ptr failure_;  // the first one
  OneShotTimer deadline_;
};

}  // namespace deros_runtime_cpp

#endif  // DEROS_RUNTIME_CPP__MONITOR_RUNNER_HPP_
