// Copyright and licence: see package.xml.

#include "deros_runtime_cpp/safety_node_core.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include "deros_runtime_cpp/instance.hpp"
#include "deros_runtime_cpp/realtime.hpp"
#include "deros_runtime_cpp/text.hpp"

namespace deros_runtime_cpp
{

namespace
{

constexpr Time REPORT_DELAY = 2'000'000;  // ns from an action to its report
constexpr Time HOUSEKEEPING_PERIOD = 100'000'000;  // ns

std::size_t domain_of(rclcpp::Node & node)
{
  return node.get_node_base_interface()->get_context()->get_domain_id();
}

std::string heartbeat_of(rclcpp::Node & node)
{
  return node.get_node_topics_interface()->resolve_topic_name("~/heartbeat");
}

}  // namespace

SafetyNodeCore::SafetyNodeCore(
  rclcpp::Node & node, SafetyNodeHooks & hooks, const RuleMetadata & metadata, Settings settings)
: node_(node),
  hooks_(hooks),
  metadata_(metadata),
  settings_(std::move(settings)),
  name_(node.get_fully_qualified_name()),
  grace_(std::llrint(settings_.startup_grace * 1e9)),
  period_(std::llrint(1e9 / settings_.publish_freq)),
  not_permitted_(configure_process(settings_.realtime_priority, settings_.lock_memory)),
  clock_choice_(refuse_clock_change(node)),
  group_(node.create_callback_group(rclcpp::CallbackGroupType::MutuallyExclusive, false)),
  simulated_(
    simulated_time(node, event_loop_, [this](bool stepped) {runner_.clock_changed(stepped);})),
  runner_(event_loop_, clock_of(simulated_), *this),
  reporter_(metadata, reporter_environment()),
  diagnostics_(event_loop_, metadata, settings_.diagnostics_freq, diagnostics_environment()),
  duplicates_(
    node, heartbeat_of(node),
    [this](const std::string & subject, const std::string & text) {report_fault(subject, text);}),
  publishers_(
    node,
    [this](const std::string & subject, const std::string & text) {report_fault(subject, text);}),
  active_(metadata.actions.size()),
  enabled_(metadata.behaviours.size(), true),
  publish_timer_(event_loop_, clock_of(simulated_), [this] {publish();}),
  report_timer_(event_loop_, Clock(), [this] {flush_reports();}, [this] {return runner_.defer();}),
  housekeeping_timer_(event_loop_, Clock(), [this] {do_housekeeping();}),
  parameter_changes_(event_loop_.add_source([this] {switch_behaviours();}, 1)),
  ports_(
    event_loop_,
    [this](const std::string & topic, const std::string & why) {report_undecodable(topic, why);}),
  worker_(
    event_loop_,
    [this](const char * why) {
      if (node_.get_node_base_interface()->get_context()->is_valid()) {  // else all nodes end
        RCLCPP_FATAL(node_.get_logger(), "%s", why);
      }
    })
{
  pending_reports_.reserve(2 * SLOTS);
  slots_.reserve(2 * SLOTS);
  try {
    lock_ = claim(name_, domain_of(node));
  } catch (const std::system_error & error) {
    not_permitted_.push_back(
      std::string("a second instance on this machine would not be seen: ") + error.what());
  }
}

SafetyNodeCore::~SafetyNodeCore()
{
  stop();
}

// Start

void SafetyNodeCore::start(
  const std::vector<Topic> & topics, const std::vector<std::string> & states,
  std::vector<Service> services)
{
  services_ = std::move(services);
  received_.resize(topics.size());
  report_start();
  open_latches();
  open_services();
  for (const std::string & topic : states) {
    duplicates_.add(node_.get_node_topics_interface()->resolve_topic_name(topic));
  }
  if (simulated_) {
    publishers_.add(simulated_->subscription(), "rosgraph_msgs/msg/Clock");
  }
  for (const Topic & topic : topics) {
    const std::string name = node_.get_node_topics_interface()->resolve_topic_name(topic.name);
    group_->find_subscription_ptrs_if(
      [&](const rclcpp::SubscriptionBase::SharedPtr & subscription) {
        const bool is_found = subscription->get_topic_name() == name;
        if (is_found) {
          publishers_.add(
            *subscription, topic.type, topic.is_shared,
            topic.needs_one_publisher ? topic.name : "");
        }
        return is_found;
      });
  }
  runner_.start();
  run_latched();
  housekeeping_timer_.schedule(0);
  diagnostics_.start();
  ports_.serve(*group_);
  worker_.start();
}

void SafetyNodeCore::begin(Time start)
{
  hooks_.start_monitor(start, grace_);
  for (std::size_t i = 0; latches_ && i < metadata_.actions.size(); ++i) {
    const Action & action = metadata_.actions[i];
    if (action.latch && latches_->is_active(*action.latch)) {
      hooks_.latch(i);
      active_[i] = true;
    }
  }
  for (std::size_t i = 0; i < metadata_.behaviours.size(); ++i) {
    if (metadata_.behaviours[i].is_optional) {
      enabled_[i] = hooks_.is_enabled(i);
      hooks_.enable(start, i, enabled_[i]);
    }
  }
  hooks_.show_states(active_);
  for (const Service & service : services_) {
    service.call->set_active(active_[service.action]);
  }
  publish_timer_.schedule(start + period_);
}

void SafetyNodeCore::report_start()
{
  const std::string count = std::to_string(metadata_.rule_count);
  reporter_.report(ReportKind::Start, OK, "watching " + count + " rules of " + metadata_.rules);
  for (const std::string & text : not_permitted_) {
    reporter_.report(ReportKind::NotPermitted, WARN, text);
  }
  for (std::size_t i = 0; i < metadata_.actions.size(); ++i) {
    const Action & action = metadata_.actions[i];
    if (action.is_code && !hooks_.is_implemented(i)) {
      const std::string text =
        "action " + action.name + " does nothing: write its code in " + metadata_.actions_file;
      reporter_.report(ReportKind::Unfilled, ERROR, text, {{"action", action.name}});
    }
  }
}

void SafetyNodeCore::open_latches()
{
  std::vector<std::string> known;
  for (const Action & action : metadata_.actions) {
    if (action.latch) {
      known.push_back(action.name);
    }
  }
  if (known.empty()) {
    return;
  }
  std::filesystem::path path = settings_.state_file;
  if (path.empty()) {
    path = default_path(file_stem(name_, domain_of(node_)));
  }
  latches_ = std::make_unique<Latches>(
    LatchFile(path, name_), known,
    [this](const std::string & subject, const std::string & text) {report_fault(subject, text);});
  report_latched();
}

void SafetyNodeCore::open_services()
{
  for (const Service & service : services_) {
    const std::string & action = metadata_.actions[service.action].name;
    service.call->attach(
      [this, action](const std::string & text) {report_fault("call of " + action, text);},
      [this, action](const std::string & name) {
        reporter_.report(
          ReportKind::Answered, OK, action + ": " + name + " has answered success",
          {{"action", action}, {"service", name}});
      });
  }
}

/// Report the actions that were active when the last process of this node ended.
void SafetyNodeCore::report_latched()
{
  for (std::size_t i = 0; i < metadata_.actions.size(); ++i) {
    const Action & action = metadata_.actions[i];
    if (!action.latch || !latches_->is_active(*action.latch)) {
      continue;
    }
    const std::string text = action.name + " is active, as it was before the start";
    reporter_.report(ReportKind::Latched, WARN, text, {{"action", action.name}});
    diagnostics_.latched(i);
  }
}

/// Run the robot code of these actions; their states have been published.
void SafetyNodeCore::run_latched()
{
  std::vector<Event> calls;
  for (const Action & action : metadata_.actions) {
    if (action.is_code && action.first_call && action.latch && latches_->is_active(*action.latch)) {
      calls.push_back({0, EventKind::Trigger, *action.first_call});
    }
  }
  runner_.run_again(calls);
}

// Orders of the monitor

void SafetyNodeCore::advance(Time now)
{
  hooks_.advance_monitor(now);
}

Time SafetyNodeCore::next_deadline() const
{
  return hooks_.next_deadline();
}

std::optional<std::size_t> SafetyNodeCore::action_of(const Event & event) const
{
  return metadata_.sites[event.site].action;
}

bool SafetyNodeCore::show(const Event & event)
{
  const std::optional<std::size_t> number = action_of(event);
  if (!number || event.kind == EventKind::Refused) {
    return true;
  }
  const Action & action = metadata_.actions[*number];
  if (action.latch && event.kind == EventKind::Trigger) {
    latches_->mark_pending(*action.latch);
  }
  if (action.is_bound) {
    active_[*number] = event.kind == EventKind::Trigger;
    hooks_.show_state(*number, active_);
  }
  for (Service & service : services_) {
    if (service.action == *number) {
      service.is_due = event.kind == EventKind::Trigger;
      if (!service.is_due) {
        service.call->set_active(false);
      }
    }
  }
  return !action.is_code || event.kind != EventKind::Trigger;
}

/// Call the services of actions that have been triggered.
void SafetyNodeCore::call_services()
{
  for (Service & service : services_) {
    if (service.is_due) {
      service.is_due = false;
      service.call->set_active(true);
    }
  }
}

void SafetyNodeCore::run_code(const Event & event)
{
  call_services();
  const std::size_t number = *action_of(event);
  if (hooks_.is_implemented(number)) {
    hooks_.run(event.site);
  } else {
    const std::string call =
      metadata_.actions[number].name + '(' + metadata_.sites[event.site].arguments + ')';
    log(
      ERROR, "action " + call + " should have been carried out now: write its code in " +
      metadata_.actions_file);
  }
}

/// Save a snapshot for some events; when no slot is free, the last one is used again.
void SafetyNodeCore::save_snapshot(std::size_t count)
{
  slot_count_ = std::min(slot_count_ + 1, SLOTS);
  hooks_.save_snapshot(slot_count_ - 1);
  slots_.resize(count, slot_count_ - 1);
}

void SafetyNodeCore::after(const std::vector<Event> & events, const std::vector<Time> & done)
{
  call_services();
  if (latches_) {
    for (const Event & event : events) {
      const std::optional<std::size_t> number = action_of(event);
      if (number && metadata_.actions[*number].latch) {
        latches_->record(*metadata_.actions[*number].latch, event.kind != EventKind::Reset);
      }
    }
    latches_->persist();
  }
  for (std::size_t i = 0; i < events.size(); ++i) {
    pending_reports_.push_back({events[i], done[i], slots_[i]});
  }
  slots_.clear();
  if (slot_count_ == SLOTS) {
    flush_reports();
  } else if (!report_timer_.is_scheduled()) {  // later: first, other nodes react to the states
    report_timer_.schedule(steady_now() + REPORT_DELAY);
  }
}

void SafetyNodeCore::flush_reports()
{
  std::optional<std::size_t> slot;
  MonitorSnapshot after;
  for (const PendingReport & report : pending_reports_) {
    if (slot != report.slot) {
      slot = report.slot;
      after = hooks_.snapshot(slot);
    }
    reporter_.report_monitor_event(report.event, report.done, after);
    diagnostics_.update(report.event, after);
  }
  pending_reports_.clear();
  slot_count_ = 0;
  diagnostics_.changed();
}

void SafetyNodeCore::report_failure(const Event & event, const char * why)
{
  const std::optional<std::size_t> number = action_of(event);
  const std::string name = number ? metadata_.actions[*number].name : "";
  RCLCPP_FATAL(node_.get_logger(), "action %s failed: %s", name.c_str(), why);
}

void SafetyNodeCore::report_fault(const std::string & subject, const std::string & text)
{
  if (diagnostics_.fault(subject, text) && !text.empty()) {
    reporter_.report(ReportKind::Fault, ERROR, subject + ": " + text, {{"subject", subject}});
  }
}

/// Report a message that cannot be deserialized, once per topic; it is ignored.
void SafetyNodeCore::report_undecodable(const std::string & topic, const std::string & why)
{
  const std::string text = topic + " has carried data that cannot be read";
  if (diagnostics_.fault("data of " + topic, text)) {
    reporter_.report(ReportKind::Undecodable, ERROR, text + ": " + why, {{"topic", topic}});
  }
}

// States and heartbeat

void SafetyNodeCore::clock_stepped()
{
  publish();
}

/// Publish all states, and the heartbeat if the node is ready.
void SafetyNodeCore::publish()
{
  publish_timer_.repeat(period_);
  hooks_.show_states(active_);
  if (is_ready()) {
    ++heartbeats_;
    hooks_.send_heartbeat(heartbeats_);
  }
}

/// Run the periodic checks.
void SafetyNodeCore::do_housekeeping()
{
  housekeeping_timer_.repeat(HOUSEKEEPING_PERIOD);
  duplicates_.check();
  publishers_.check();
  for (const Service & service : services_) {
    service.call->check();
  }
  if (latches_) {
    latches_->persist();
  }
}

/// Return whether simulated time has not begun, so that nothing can become due.
bool SafetyNodeCore::awaits_clock() const
{
  return simulated_ && !simulated_->has_begun();
}

/// Return whether the start is over, or a step of the clock: nothing is awaited.
bool SafetyNodeCore::is_ready()
{
  const bool is_waiting = awaits_clock() || hooks_.is_waiting();
  if (is_waiting != is_starting_) {
    is_starting_ = is_waiting;
    diagnostics_.changed();
  }
  return !is_waiting;
}

/// Return why the node does not watch all rules; an empty text if it does.
std::string SafetyNodeCore::not_ready_reason() const
{
  if (awaits_clock()) {
    return "starting: waits for /clock, no heartbeat until then";
  }
  if (is_starting_) {
    return "starting: no heartbeat until all inputs have come, or are missing";
  }
  std::vector<std::string> disabled;
  for (std::size_t i = 0; i < enabled_.size(); ++i) {
    if (!enabled_[i]) {
      disabled.push_back(metadata_.behaviours[i].name);
    }
  }
  return disabled.empty() ? "" : "disabled: " + joined(disabled, ", ");
}

// Requests

std::string SafetyNodeCore::reset(bool & success)
{
  success = false;
  const Time now = runner_.advance();
  const MonitorSnapshot present = hooks_.snapshot(std::nullopt);
  std::vector<std::pair<std::string, std::string>> active;  // and why each stays active
  LatchFile::Names remaining;
  for (std::size_t i = 0; i < metadata_.actions.size(); ++i) {
    const Action & action = metadata_.actions[i];
    if (action.latch && latches_->is_active(*action.latch)) {
      active.emplace_back(action.name, reporter_.refusal(i, present));
      if (!active.back().second.empty()) {
        remaining.insert(action.name);
      }
    }
  }
  const std::string refusal = latches_->allow_reset(remaining);
  if (!refusal.empty()) {
    return refusal;
  }
  success = hooks_.reset_monitor(now);
  runner_.settle();
  std::sort(active.begin(), active.end());
  std::vector<std::string> results;
  for (const auto & [name, why] : active) {
    results.push_back(why.empty() ? name + " is reset" : name + " stays active, " + why);
  }
  return results.empty() ? "no latched action was active" : joined(results, "; ");
}

void SafetyNodeCore::parameters_changed()
{
  event_loop_.notify(parameter_changes_);
}

/// Enable or disable the behaviours whose parameter has changed.
void SafetyNodeCore::switch_behaviours()
{
  for (std::size_t i = 0; i < metadata_.behaviours.size(); ++i) {
    const Behaviour & behaviour = metadata_.behaviours[i];
    if (!behaviour.is_optional || hooks_.is_enabled(i) == enabled_[i]) {
      continue;
    }
    const bool enabled = !enabled_[i];
    enabled_[i] = enabled;
    hooks_.enable(runner_.catch_up(), i, enabled);
    runner_.settle();
    const ReportKind kind = enabled ? ReportKind::Enabled : ReportKind::Disabled;
    const std::string text = behaviour.name + (enabled ? " is enabled" : " is disabled");
    reporter_.report(kind, enabled ? OK : WARN, text, {{"behaviour", behaviour.name}});
    diagnostics_.changed();
  }
}

// Lifetime

void SafetyNodeCore::stop()
{
  worker_.stop();
  if (!pending_reports_.empty()) {
    flush_reports();
  }
}

void SafetyNodeCore::when_ended(std::function<void()> ended)
{
  worker_.when_ended(std::move(ended));
}

std::exception_ptr SafetyNodeCore::failure() const
{
  return worker_.failure();
}

// Environment

void SafetyNodeCore::log(Level level, const std::string & text) const
{
  if (level == OK) {
    RCLCPP_INFO(node_.get_logger(), "%s", text.c_str());
  } else if (level == WARN) {
    RCLCPP_WARN(node_.get_logger(), "%s", text.c_str());
  } else {
    RCLCPP_ERROR(node_.get_logger(), "%s", text.c_str());
  }
}

EventReporter::Environment SafetyNodeCore::reporter_environment()
{
  return {
    name_,
    [this] {return node_.now().nanoseconds();},
    [this] {return runner_.origin();},
    [this](Level level, const std::string & text) {log(level, text);},
    [this](const EventReporter::Status & event) {hooks_.report_event(event);},
  };
}

Diagnostics::Environment SafetyNodeCore::diagnostics_environment()
{
  return {
    name_,
    [this] {return hooks_.snapshot(std::nullopt);},
    [this] {return runner_.now();},
    [this] {return runner_.origin();},
    [this] {return not_ready_reason();},
    [this](Diagnostics::Message & message) {
      message.header.stamp = node_.now();
      hooks_.report_diagnostics(message);
    },
    [this] {return runner_.defer();},
    [this] {return awaits_clock() ? MonitorCopies() : hooks_.copies();},
    [this](std::size_t topic) {return received_[topic];},
  };
}

}  // namespace deros_runtime_cpp
