// Copyright and licence: see package.xml.

#include "deros_runtime_cpp/gate_report.hpp"

#include <algorithm>
#include <array>
#include <cstdio>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "deros_runtime_cpp/text.hpp"
#include "diagnostic_msgs/msg/key_value.hpp"

namespace deros_runtime_cpp
{

namespace
{

using Status = diagnostic_msgs::msg::DiagnosticStatus;

constexpr Time PERIOD = 1'000'000'000;  // ns
constexpr Time CHANGE_DELAY = 50'000'000;  // ns from a change to its message, to include others
// By which its reports are told from those of other nodes.
constexpr const char * HARDWARE_ID = "deros gate";
constexpr const char * WAITS = "waits for /clock: simulated time has not begun";

/// Return a time as text.
std::string ago(Time time)
{
  std::array<char, 64> text{};
  const double seconds = static_cast<double>(std::max(time, Time{0})) / 1e9;
  std::snprintf(text.data(), text.size(), "%.3f s ago", seconds);
  return text.data();
}

}  // namespace

GateReport::GateReport(
  EventLoop & event_loop, rclcpp::Node & node, const Gate & gate, Clock clock,
  std::function<void(const Message &)> publish, const std::string & target)
: node_(node),
  gate_(gate),
  texts_(gate.reports()),
  clock_(std::move(clock)),
  publish_(std::move(publish)),
  is_simulated_(node.get_parameter("use_sim_time").as_bool()),
  publishers_(
    node,
    [this](const std::string & subject, const std::string & text) {fault(subject, text);}),
  target_(
    event_loop, node, target,
    [this](const std::string & subject, const std::string & text) {fault(subject, text);}),
  timer_(event_loop, Clock(), [this] {fire();})
{
}

void GateReport::start()
{
  timer_.schedule(0);
  target_.start();
}

void GateReport::check()
{
  if (reported_ != gate_.applying() || source_ != gate_.source_name()) {
    report_soon();
  }
}

void GateReport::refuse(const std::string & cause)
{
  ++refused_;
  cause_ = cause;
  report_soon();
}

std::string GateReport::answer(bool is_reset) const
{
  if (!is_reset) {
    std::vector<std::string> against;
    for (std::size_t line = 0; line < gate_.table().lines.size(); ++line) {
      if (gate_.refuses(line)) {
        against.push_back(texts_[line]);
      }
    }
    const std::string text = "not reset, because this applies: " + joined(against, "; ");
    RCLCPP_WARN(node_.get_logger(), "%s", text.c_str());
    return text;
  }
  const std::string left = applying();
  const std::string text = "reset: " + (left.empty() ? fine() : left);
  RCLCPP_INFO(node_.get_logger(), "%s", text.c_str());
  return text;
}

void GateReport::fault(const std::string & subject, const std::string & text)
{
  const auto known = std::find_if(
    faults_.begin(), faults_.end(), [&subject](const auto & each) {return each.first == subject;});
  if (known != faults_.end()) {
    if (known->second == text) {
      return;
    }
    faults_.erase(known);
  } else if (text.empty()) {
    return;
  }
  if (!text.empty()) {
    faults_.emplace_back(subject, text);
    RCLCPP_ERROR(node_.get_logger(), "%s: %s", subject.c_str(), text.c_str());
  }
  report_soon();
}

void GateReport::check_publishers_of(SubscribedTopic topic)
{
  publishers_.add(std::move(topic));
}

void GateReport::report_soon()
{
  const Time soon = steady_now() + CHANGE_DELAY;
  if (!timer_.is_scheduled() || timer_.due() > soon) {
    timer_.schedule(soon);
  }
}

void GateReport::fire()
{
  timer_.schedule(steady_now() + PERIOD);
  if (reported_ != gate_.applying() || source_ != gate_.source_name()) {
    log();
    reported_ = gate_.applying();
    source_ = gate_.source_name();
  }
  Message message;
  message.header.stamp = node_.now();
  message.status.push_back(status());
  publish_(message);
  publishers_.check();
  target_.check();
}

/// Return whether no message of /clock has come yet, on which the time of the node depends.
bool GateReport::awaits_clock() const
{
  return is_simulated_ && node_.now().nanoseconds() == 0;
}

void GateReport::log() const
{
  const std::string name(gate_.source_name());
  const std::string source = name.empty() ? "" : " (source: " + name + ")";
  const std::string text = applying();
  if (text.empty()) {
    RCLCPP_INFO(node_.get_logger(), "%s", fine().c_str());
  } else {
    RCLCPP_WARN(node_.get_logger(), "%s%s", text.c_str(), source.c_str());
  }
}

/// Return the text for when nothing holds commands back.
std::string GateReport::fine() const
{
  const std::string name(gate_.source_name());
  return name.empty() ? "commands pass" : "commands of " + name + " pass";
}

/// Return the texts of what holds commands back.
std::string GateReport::applying() const
{
  std::vector<std::string> found;
  for (std::size_t number = 0; number < texts_.size(); ++number) {
    if (gate_.applying()[number]) {
      found.push_back(texts_[number]);
    }
  }
  return joined(found, "; ");
}

Status GateReport::status() const
{
  std::vector<std::string> shown;
  Status status;
  status.name = node_.get_fully_qualified_name();
  status.hardware_id = HARDWARE_ID;
  status.level = faults_.empty() ? Status::OK : Status::ERROR;
  const auto add = [&status](const std::string & key, const std::string & value) {
      diagnostic_msgs::msg::KeyValue pair;
      pair.key = key;
      pair.value = value;
      status.values.push_back(pair);
    };
  add("since", ago(clock_.now() - gate_.since()));
  add("since_ns", std::to_string(gate_.since() + clock_.origin()));
  add("refused", std::to_string(refused_));
  add("refused_last", cause_);
  if (gate_.table().sources.size() != 0) {
    const std::string name(gate_.source_name());
    add("source", name.empty() ? "none" : name);
  }
  for (const auto & [subject, text] : faults_) {
    add(subject, text);
    shown.push_back(text);
  }
  if (awaits_clock()) {
    status.level = std::max(status.level, Status::WARN);
    shown.emplace_back(WAITS);
  }
  const Rows<Line> & lines = gate_.table().lines;  // after these are latches and waits
  for (std::size_t number = 0; number < texts_.size(); ++number) {
    if (gate_.applying()[number]) {
      const bool is_severe =
        number < lines.size() && lines[number].severity == Severity::SEVERE;
      status.level = is_severe ? Status::ERROR : std::max(status.level, Status::WARN);
      shown.push_back(texts_[number]);
    }
  }
  status.message = shown.empty() ? fine() : joined(shown, "; ");
  return status;
}

}  // namespace deros_runtime_cpp
