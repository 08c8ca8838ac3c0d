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

#include "deros_runtime_cpp/clock_choice.hpp"
#include "deros_runtime_cpp/descriptor.hpp"
#include "deros_runtime_cpp/diagnostics.hpp"
#include "deros_runtime_cpp/duplicate_instance.hpp"
#include "deros_runtime_cpp/event_loop.hpp"
#include "deros_runtime_cpp/events.hpp"
#include "deros_runtime_cpp/latches.hpp"
#include "deros_runtime_cpp/monitor_runner.hpp"
#include "deros_runtime_cpp/ports.hpp"
#include "deros_runtime_cpp/publishers.hpp"
#include "deros_runtime_cpp/report_types.hpp"
#include "deros_runtime_cpp/simulated_time.hpp"
#include "deros_runtime_cpp/worker.hpp"
#include "rclcpp/rclcpp.hpp"

namespace deros_runtime_cpp
{

/// Of each action whether it is active.
using Active = std::vector<bool>;

/// What the rules of one robot add to a safety node; actions and behaviours by their numbers.
class SafetyNodeHooks
{
public:
  virtual ~SafetyNodeHooks() = default;

  /// Start the monitor; timeouts count from grace nanoseconds later.
  virtual void start_monitor(Time start, Time grace) = 0;

  /// Have the monitor take a latched action as active, from its start.
  virtual void latch(std::size_t action) = 0;

  /// Enable or disable an optional behaviour; tell whether its parameter enables it.
  virtual void enable(Time now, std::size_t behaviour, bool enabled) = 0;
  virtual bool is_chosen(std::size_t behaviour) const = 0;

  /// Settle what is due; return when to do so again at the latest.
  virtual void advance_monitor(Time now) = 0;
  virtual Time next_deadline() const = 0;

  /// Reset the latched actions that no behaviour calls for; tell whether none is left.
  virtual bool reset_monitor(Time now) = 0;

  /// Tell whether an input has yet to come for the first time, and is not missing yet.
  virtual bool is_waiting() const = 0;

  /// Remember what the monitor is worth now, for one of SLOTS later uses.
  virtual void remember(std::size_t slot) = 0;

  /// Return what the monitor was worth then, or is now.
  virtual MonitorSnapshot explain(std::optional<std::size_t> slot) const = 0;

  /// Publish the topic that shows an action, or all of them.
  virtual void show_state(std::size_t action, const Active & active) = 0;
  virtual void show_states(const Active & active) = 0;

  /// Publish the heartbeat.
  virtual void beat(std::uint64_t count) = 0;

  /// Publish a report.
  virtual void report_event(const Events::Status & event) = 0;
  virtual void report_diagnostics(const Diagnostics::Message & message) = 0;

  /// Tell whether the robot code of an action has been written, and run what a site calls.
  virtual bool is_filled_in(std::size_t action) const = 0;
  virtual void run(std::size_t site) = 0;
};

/// How many explanations can wait to be told.
constexpr std::size_t SLOTS = 32;

/// The part of a safety node that is the same for all rules; all of it runs in one thread.
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

  /// A topic of the rules, its type, and whether it may have any number of publishers.
  struct Topic
  {
    std::string name;
    std::string type;
    bool is_shared;
  };

  /// Refuse to be a second one of the node's name, and prepare the process.
  /** \throw Refusal if there is one */
  SafetyNodeCore(
    rclcpp::Node & node, SafetyNodeHooks & hooks, const RuleMetadata & metadata,
    Settings settings);
  ~SafetyNodeCore() override;

  /// Return the callback group of the ports that this thread serves.
  const rclcpp::CallbackGroup::SharedPtr & group() const
  {
    return group_;
  }

  /// Start watching, with the ports that the group has now; states are the topics with states.
  void start(const std::vector<Topic> & topics, const std::vector<std::string> & states);

  /// Note that parameters have changed; from any thread.
  void parameters_changed();

  // What the thread of the node does

  /// Settle what is due before a message, and return the time that the monitor is told.
  Time catch_up()
  {
    return runner_.catch_up();
  }

  /// Do what the monitor ordered; to be called after each message.
  void settle()
  {
    runner_.settle();
  }

  /// Take an event while the monitor evaluates.
  void take(const Event & event) noexcept
  {
    runner_.take(event);
  }

  /// Reset the latched actions that no behaviour calls for any more; return what to answer.
  std::string reset(bool & success);

  // What others do

  /// End the thread; see Worker.
  void stop();
  void when_ended(std::function<void()> ended);
  std::exception_ptr failure() const;

private:
  /// An event that has been acted upon and is still to be told of.
  struct Untold
  {
    Event event;
    Time done;
    std::size_t slot;
  };

  void begin(Time start) override;
  void advance(Time now) override;
  Time due() const override;
  bool show(const Event & event) override;
  void run_code(const Event & event) override;
  void remember(std::size_t count) override;
  void after(const std::vector<Event> & events, const std::vector<Time> & done) override;
  void tell() override;
  void tell_failure(const Event & event, const char * why) override;
  void stepped() override;

  std::optional<std::size_t> action_of(const Event & event) const;
  void open_latches();
  void latch_again();
  void run_latched();
  void tell_start();
  void tell_fault(const std::string & subject, const std::string & text);
  void refuse(const std::string & topic, const std::string & why);
  void publish();
  void do_housekeeping();
  void switch_behaviours();
  bool is_ready();
  std::string not_ready_reason() const;
  void log(Level level, const std::string & text) const;
  Events::Outside outside_of_events();
  Diagnostics::Outside outside_of_diagnostics();

  rclcpp::Node & node_;
  SafetyNodeHooks & hooks_;
  const RuleMetadata & metadata_;
  const Settings settings_;
  const std::string name_;
  const Time grace_;
  const Time period_;
  std::vector<std::string> refused_;  // by the machine
  Descriptor lock_;
  const ClockChoice clock_choice_;
  rclcpp::CallbackGroup::SharedPtr group_;
  EventLoop event_loop_;
  std::unique_ptr<SimulatedTime> simulated_;
  MonitorRunner runner_;
  Events events_;
  Diagnostics diagnostics_;
  DuplicateInstanceDetector duplicates_;
  Publishers publishers_;
  std::unique_ptr<Latches> latches_;
  Active active_;
  std::vector<bool> enabled_;
  std::vector<Untold> untold_;
  std::vector<std::size_t> slots_;  // of the events that after() is going to take
  std::size_t slot_ = 0;  // how many are in use
  std::uint64_t beats_ = 0;
  bool is_starting_ = true;
  OneShotTimer publishing_;
  OneShotTimer telling_;
  OneShotTimer housekeeping_;
  std::size_t switching_;  // the source of the event loop
  Ports ports_;
  Worker worker_;
};

}  // namespace deros_runtime_cpp

#endif  // DEROS_RUNTIME_CPP__SAFETY_NODE_CORE_HPP_
