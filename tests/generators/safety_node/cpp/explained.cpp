// The C monitor, its explanation and its reports: reads input values line by line, and prints all.

#include <cstdint>
#include <iostream>
#include <limits>
#include <string>
#include <vector>

#include "every_thing_safety_cpp/runtime/event_reporter.hpp"
#include "every_thing_safety_cpp/runtime/text.hpp"
#include "every_thing_safety_node_messages.hpp"
#include "every_thing_safety_node_rule_metadata.hpp"

namespace told = every_thing_safety_cpp;

void every_thing_emit(void * owner, int64_t t, every_thing_kind kind, uint32_t site)
{
  if (owner == nullptr) {  // a copy that looks ahead
    return;
  }
  const std::size_t place = site == EVERY_THING_SITE_NONE ? EVERY_THING_SITE_COUNT : site;
  static_cast<std::vector<told::runtime::Event> *>(owner)->push_back(
    {t, static_cast<told::runtime::EventKind>(kind), place});
}

namespace
{

sensor_msgs::msg::JointState joints(double last, int count)
{
  sensor_msgs::msg::JointState msg;
  for (int i = 0; i < count; ++i) {
    msg.position.push_back(last);
  }
  return msg;
}

void tell(
  const char * kind, const std::vector<std::size_t> & behaviours,
  const told::runtime::MonitorSnapshot & state)
{
  for (const std::size_t behaviour : behaviours) {
    if (state.causes.count(behaviour) == 0) {  // unknown, and refuses no reset
      continue;
    }
    std::cout << kind << '\t' << told::rule_metadata().behaviours[behaviour].name << '\t' <<
      told::runtime::cause_of(behaviour, state) << '\n';
  }
}

void tell(const every_thing_monitor & monitor)
{
  const told::runtime::MonitorSnapshot state = told::monitor_snapshot(monitor);
  for (const auto & rule : state.rules) {
    const std::string value = told::runtime::to_text(rule.verdict);
    std::cout << rule.name << '\t' << rule.line << '\t' << rule.text << '\t' << value << '\t' <<
      rule.since;
    for (const auto & read : rule.reads) {
      std::cout << '\t' << read.term << '=' << read.value.value_or("unknown");
    }
    for (const auto & cause : rule.causes) {
      std::cout << '\t' << cause;
    }
    std::cout << '\n';
  }
  tell("holding", state.holding, state);
  tell("unknown", state.unknown, state);
  tell("coming", state.coming, state);
  told::runtime::LookAhead ahead(state.rules, told::monitor_copies(monitor));
  while (ahead.step()) {
  }
  for (std::size_t i = 0; i < state.rules.size(); ++i) {
    for (const auto & next : ahead.found()[i]) {
      std::cout << state.rules[i].name << '\t' << next.condition << '\t' <<
        told::runtime::to_text(next.verdict) << '\t' << next.at << '\n';
    }
  }
  std::cout << "." << std::endl;
}

void print(const diagnostic_msgs::msg::DiagnosticStatus & status)
{
  std::cout << int{status.level} << '\t' << status.message;
  for (const auto & value : status.values) {
    std::cout << '\t' << value.key << '=' << value.value;
  }
  std::cout << '\n';
}

}  // namespace

int main()
{
  std::vector<told::runtime::Event> events;
  told::runtime::EventReporter reporter(
    told::rule_metadata(), {"/safety", [] {return 9;}, [] {return 0;},
      [](told::runtime::Level level, const std::string & message) {
        std::cout << int{level} << '\t' << message << '\n';
      }, print});
  every_thing_monitor monitor;
  every_thing_start(&monitor, &events, 0, 0);
  std::string topic;
  std::int64_t now = 0;
  double value = 0.0;
  while (std::cin >> topic >> now >> value) {
    if (topic == "speed") {
      std_msgs::msg::Float64 msg;
      msg.data = value;
      told::take_speed(monitor, now, msg);
    } else if (topic == "mode") {
      std_msgs::msg::UInt8 msg;
      msg.data = static_cast<std::uint8_t>(value);
      told::take_mode(monitor, now, msg);
    } else if (topic == "level") {
      diagnostic_msgs::msg::DiagnosticStatus msg;
      msg.level = static_cast<unsigned char>(value);
      told::take_diagnostics(monitor, now, msg);
    } else if (topic == "imu") {
      sensor_msgs::msg::Imu msg;
      msg.orientation.x = value;
      msg.orientation.w = 1.0;
      msg.angular_velocity_covariance[4] = value;
      told::take_imu(monitor, now, msg);
    } else {
      told::take_joints(monitor, now, joints(value, topic == "joints" ? 3 : 2));
    }
    for (const auto & event : events) {
      reporter.report_monitor_event(event, now, told::monitor_snapshot(monitor));
    }
    events.clear();
    tell(monitor);
  }
  return 0;
}
