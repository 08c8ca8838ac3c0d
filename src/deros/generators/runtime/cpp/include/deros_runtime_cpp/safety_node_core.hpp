// Copyright and licence: see package.xml.

#ifndef DEROS_RUNTIME_CPP__SAFETY_NODE_CORE_HPP_
#define DEROS_RUNTIME_CPP__SAFETY_NODE_CORE_HPP_

#include <cstddef>
#include <cstdint>
#include <exception>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "deros_runtime_cpp/bound_service.hpp"
#include "deros_runtime_cpp/clock_choice.hpp"
#include "deros_runtime_cpp/descriptor.hpp"
#include "deros_runtime_cpp/diagnostics.hpp"
#include "deros_runtime_cpp/duplicate_instance.hpp"
#include "deros_runtime_cpp/event_loop.hpp"
#include "deros_runtime_cpp/event_reporter.hpp"
#include "deros_runtime_cpp/latches.hpp"
#include "deros_runtime_cpp/look_ahead.hpp"
#include "deros_runtime_cpp/monitor_runner.hpp"
#include "deros_runtime_cpp/ports.hpp"
#include "deros_runtime_cpp/publishers.hpp"
#include "deros_runtime_cpp/report_types.hpp"
#include "deros_runtime_cpp/simulated_time.hpp"
#include "deros_runtime_cpp/worker.hpp"
#include "rclcpp/rclcpp.hpp"

namespace deros_runtime_cpp
{

/// The active flag of each action.
using Active = std::vector<bool>;

/// What the rules of one robot add to a safety node. Actions and behaviours have numbers.
class SafetyNodeHooks
{
public:
  virtual ~SafetyNodeHooks() = default;

  /// Start the monitor; timeouts count from grace nanoseconds later.
  virtual void start_monitor(Time start, Time grace) = 0;

  /// Make a latched action active from the start of the monitor.
  virtual void latch(std::size_t action) = 0;

  /// Enable or disable an optional behaviour.
  virtual void enable(Time now, std::size_t behaviour, bool enabled) = 0;

  /// Return whether the parameter of an optional behaviour enables it.
  virtual bool is_enabled(std::size_t behaviour) const = 0;

  /// Advance the monitor up to and including a time.
  virtual void advance_monitor(Time now) = 0;

  /// Return when advance_monitor() has to be called at the latest.
  virtual Time next_deadline() const = 0;

  /// Reset the latched actions that no behaviour calls; return whether none remains active.
  virtual bool reset_monitor(Time now) = 0;

  /// Return whether an input has not been received yet, and is not missing yet.
  virtual bool is_waiting() const = 0;

  /// Save the state of the monitor in one of SLOTS slots.
  virtual void save_snapshot(std::size_t slot) = 0;

  /// Return the state saved in a slot, or the present state.
  virtual MonitorSnapshot snapshot(std::optional<std::size_t> slot) const = 0;

  /// Return copies of the monitor, to look ahead.
  virtual MonitorCopies copies() const = 0;

  /// Publish the topic that carries the state of an action.
  virtual void show_state(std::size_t action, const Active & active) = 0;

  /// Publish all topics with states.
  virtual void show_states(const Active & active) = 0;

  /// Publish the heartbeat.
  virtual void send_heartbeat(std::uint64_t count) = 0;

  /// Publish the report of an event.
  virtual void report_event(const EventReporter::Status & event) = 0;

  /// Publish diagnostics.
  virtual void report_diagnostics(const Diagnostics::Message & message) = 0;

  /// Return whether the robot code of an action has been implemented.
  virtual bool is_implemented(std::size_t action) const = 0;

  /// Run the robot code that a site calls.
  virtual void run(std::size_t site) = 0;
};

/// The number of snapshots that can wait for their reports.
constexpr std::size_t SLOTS = 32;

/// The part of a safety node that is common to all rules; all of it runs in one thread.
class SafetyNodeCore : private MonitorHost
{
public:
  /// The parameters of the node.
  struct Settings
  {
    double publish_freq = 0.0;
    double startup_grace = 0.0;
    std::string state_file;
    double diagnostics_freq = 0.0;
    std::int64_t realtime_priority = 0;
    bool lock_memory = false;
  };

  /// A topic of the rules, its type, and whether it may have several publishers.
  struct Topic
  {
    std::string name;
    std::string type;
    bool is_shared;
    bool needs_one_publisher = false;  // its values are not known while there are several
  };

  /// An action that calls a service.
  struct Service
  {
    std::size_t action;
    std::shared_ptr<BoundService> call;
    bool is_due = false;  // to be called when all states are published
  };

  /// Configure the process and take the single-instance lock.
  /** \throw Refusal if a node of the same name runs already */
  SafetyNodeCore(
    rclcpp::Node & node, SafetyNodeHooks & hooks, const RuleMetadata & metadata,
    Settings settings);
  ~SafetyNodeCore() override;

  /// Return the callback group of the ports that the thread of the node serves.
  const rclcpp::CallbackGroup::SharedPtr & group() const
  {
    return group_;
  }

  /// Start the monitor and serve the ports that the group has now.
  /**
   * \param topics the topics that the node subscribes to
   * \param states the topics that carry the states of actions
   * \param services the services that actions call
   */
  void start(
    const std::vector<Topic> & topics, const std::vector<std::string> & states,
    std::vector<Service> services = {});

  /// Announce a change of parameters; from any thread.
  void parameters_changed();

  // Called in the thread of the node

  /// Return whether a topic that must not have several publishers did not when it was checked.
  bool has_one_publisher(const std::string & topic) const
  {
    return publishers_.has_one_publisher(topic);
  }

  /// Advance the monitor to the present before a message, and return the time of the message.
  /** \param topic the place of its topic among those of start() */
  Time catch_up(std::size_t topic)
  {
    const Time now = runner_.catch_up();
    received_[topic] = now;
    return now;
  }

  /// Execute what the monitor ordered; to be called after each message.
  void settle()
  {
    runner_.settle();
  }

  /// Handle an event while the monitor evaluates.
  void take(const Event & event) noexcept
  {
    runner_.take(event);
  }

  /// Reset the latched actions that no behaviour calls any more; return the text of the response.
  std::string reset(bool & success);

  // Called in other threads

  /// Stop the thread, and wait for it; see Worker.
  void stop();
  void when_ended(std::function<void()> ended);
  std::exception_ptr failure() const;

private:
  /// An event that has been executed and not been reported yet.
  struct PendingReport
  {
    Event event;
    Time done;
    std::size_t slot;
  };

  void begin(Time start) override;
  void advance(Time now) override;
  Time next_deadline() const override;
  bool show(const Event & event) override;
  void run_code(const Event & event) override;
  void save_snapshot(std::size_t count) override;
  void after(const std::vector<Event> & events, const std::vector<Time> & done) override;
  void flush_reports() override;
  void report_failure(const Event & event, const char * why) override;
  void clock_stepped() override;

  std::optional<std::size_t> action_of(const Event & event) const;
  void open_latches();
  void open_services();
  void call_services();
  void report_latched();
  void run_latched();
  void report_start();
  void report_fault(const std::string & subject, const std::string & text);
  void report_undecodable(const std::string & topic, const std::string & why);
  void publish();
  void do_housekeeping();
  void switch_behaviours();
  bool awaits_clock() const;
  bool is_ready();
  std::string not_ready_reason() const;
  void log(Level level, const std::string & text) const;
  EventReporter::Environment reporter_environment();
  Diagnostics::Environment diagnostics_environment();

  rclcpp::Node & node_;
  SafetyNodeHooks & hooks_;
  const RuleMetadata & metadata_;
  const Settings settings_;
  const std::string name_;
  const Time grace_;
  const Time period_;
  std::vector<std::string> not_permitted_;  // by the operating system
  Descriptor lock_;
  const ClockChoice clock_choice_;
  rclcpp::CallbackGroup::SharedPtr group_;
  EventLoop event_loop_;
  std::unique_ptr<SimulatedTime> simulated_;
  MonitorRunner runner_;
  EventReporter reporter_;
  Diagnostics diagnostics_;
  DuplicateInstanceDetector duplicates_;
  PublisherCheck publishers_;
  std::unique_ptr<Latches> latches_;
  std::vector<Service> services_;
  std::vector<std::optional<Time>> received_;  // the last message of each topic
  Active active_;
  std::vector<bool> enabled_;
  std::vector<PendingReport> pending_reports_;
  std::vector<std::size_t> slots_;  // of the events of the next call of after()
  std::size_t slot_count_ = 0;  // in use
  std::uint64_t heartbeats_ = 0;
  bool is_starting_ = true;
  OneShotTimer publish_timer_;
  OneShotTimer report_timer_;
  OneShotTimer housekeeping_timer_;
  std::size_t parameter_changes_;  // a source of the event loop
  Ports ports_;
  Worker worker_;
};

}  // namespace deros_runtime_cpp

#endif  // DEROS_RUNTIME_CPP__SAFETY_NODE_CORE_HPP_
