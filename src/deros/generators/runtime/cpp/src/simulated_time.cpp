// Copyright and licence: see package.xml.

#include "deros_runtime_cpp/simulated_time.hpp"

#include <cstddef>
#include <memory>
#include <utility>

namespace deros_runtime_cpp
{

namespace
{

constexpr std::size_t TICKS = 100;  // that can wait: each keeps its place among the messages

}  // namespace

SimulatedTime::SimulatedTime(
  rclcpp::Node & node, EventLoop & event_loop, std::function<void(bool)> changed)
: changed_(std::move(changed)),
  group_(node.create_callback_group(rclcpp::CallbackGroupType::MutuallyExclusive, false))
{
  rclcpp::SubscriptionOptions options;
  options.callback_group = group_;
  options.use_intra_process_comm = rclcpp::IntraProcessSetting::Disable;
  subscription_ = node.create_subscription<Message>(
    "/clock", rclcpp::ClockQoS(rclcpp::KeepLast(TICKS)),
    [](const Message &) { /* taken by the event loop */}, options);
  const std::size_t source = event_loop.add_source([this] {take();}, TICKS);
  subscription_->set_on_new_message_callback(
    [&event_loop, source](std::size_t count) {event_loop.notify(source, count);});
}

SimulatedTime::~SimulatedTime()
{
  subscription_->clear_on_new_message_callback();
}

/// Take a tick from the middleware, which also delivers those of this process.
void SimulatedTime::take()
{
  rclcpp::MessageInfo info;
  if (!subscription_->take(message_, info)) {
    return;
  }
  const Time ros_time =
    static_cast<Time>(message_.clock.sec) * 1'000'000'000 + message_.clock.nanosec;
  const Time before = now_;
  const bool begins = !has_begun() && ros_time != 0;
  if (begins) {
    origin_ = ros_time - BEGINNING;
  }
  now_ = ros_time - origin_;
  if (begins || now_ != before) {
    changed_(begins || now_ < before);
  }
}

std::unique_ptr<SimulatedTime> simulated_time(
  rclcpp::Node & node, EventLoop & event_loop, std::function<void(bool)> changed)
{
  if (!node.get_parameter("use_sim_time").as_bool()) {
    return nullptr;
  }
  return std::make_unique<SimulatedTime>(node, event_loop, std::move(changed));
}

Time start_time(const rclcpp::Node & node, bool may_be_simulated)
{
  const bool is_simulated = may_be_simulated && node.get_parameter("use_sim_time").as_bool();
  return is_simulated ? BEGINNING : steady_now();
}

Clock clock_of(const std::unique_ptr<SimulatedTime> & simulated)
{
  return simulated ? simulated->clock() : Clock();
}

}  // namespace deros_runtime_cpp
