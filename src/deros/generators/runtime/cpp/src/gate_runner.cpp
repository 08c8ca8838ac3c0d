// Copyright and licence: see package.xml.

#include "deros_runtime_cpp/gate_runner.hpp"

#include <cstddef>
#include <memory>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include "deros_runtime_cpp/gate_numbers.hpp"
#include "deros_runtime_cpp/instance.hpp"
#include "deros_runtime_cpp/realtime.hpp"

namespace deros_runtime_cpp
{

namespace
{

constexpr Time CHECK_PERIOD = 1'000'000'000;  // ns

}  // namespace

GateRunner::GateRunner(
  rclcpp::Node & node, Gate & gate, GateNode & owner, const std::string & target,
  Settings settings)
: node_(node),
  gate_(gate),
  owner_(owner),
  not_permitted_(configure_process(settings.realtime_priority, settings.lock_memory)),
  clock_choice_(refuse_clock_change(node)),
  group_(node.create_callback_group(rclcpp::CallbackGroupType::MutuallyExclusive, false)),
  simulated_(
    settings.losses_in_simulated_time ?
    simulated_time(node, event_loop_, [this](bool) {advance();}) : nullptr),
  clock_(clock_of(simulated_)),
  report_(
    event_loop_, node, gate, clock_,
    [this](const GateReport::Message & message) {owner_.report(message);}, target),
  deadline_(event_loop_, clock_, [this] {advance();}),
  check_(event_loop_, Clock(), [this] {check_publishers();}),
  ports_(event_loop_, [](const std::string &, const std::string &) {}),
  worker_(
    event_loop_,
    [this](const char * why) {
      if (node_.get_node_base_interface()->get_context()->is_valid()) {  // else all nodes end
        RCLCPP_FATAL(node_.get_logger(), "%s", why);
      }
    })
{
  if (node.get_parameter("use_sim_time").as_bool()) {
    report_.check_publishers_of({"/clock", "rosgraph_msgs/msg/Clock", rclcpp::ClockQoS()});
  }
  const std::size_t domain = node.get_node_base_interface()->get_context()->get_domain_id();
  try {
    lock_ = claim(node.get_fully_qualified_name(), domain);
  } catch (const std::system_error & error) {
    not_permitted_.push_back(
      std::string("a second instance on this machine would not be seen: ") + error.what());
  }
}

GateRunner::~GateRunner()
{
  stop();
  for (const auto & subscription : subscriptions_) {
    subscription->clear_on_new_message_callback();
  }
}

void GateRunner::start()
{
  for (const std::string & text : not_permitted_) {
    report_.fault("process", text);
  }
  report_.start();
  check_.schedule(0);
  advance();
  worker_.start();
}

void GateRunner::settle()
{
  const Time due = gate_.next_deadline();
  if (due != NEVER && !(deadline_.is_scheduled() && deadline_.due() <= due)) {
    deadline_.schedule(due);
  }
  report_.check();
}

void GateRunner::stop()
{
  worker_.stop();
}

void GateRunner::when_ended(std::function<void()> ended)
{
  worker_.when_ended(std::move(ended));
}

std::exception_ptr GateRunner::failure() const
{
  return worker_.failure();
}

/// Take each message in the thread of the gate, always into the same memory.
void GateRunner::serve(
  const rclcpp::SubscriptionBase::SharedPtr & subscription, const std::string & type)
{
  const auto data = subscription->create_serialized_message();
  const auto take = [from = subscription.get(), data] {
      rclcpp::MessageInfo info;
      if (from->take_serialized(*data, info)) {
        from->handle_serialized_message(data, info);
      }
    };
  const std::size_t source = event_loop_.add_source(take, subscription->get_actual_qos().depth());
  subscription->set_on_new_message_callback(
    [this, source](std::size_t count) {event_loop_.notify(source, count);});
  subscriptions_.push_back(subscription);
  report_.check_publishers_of(
    {subscription->get_topic_name(), type, subscription->get_actual_qos()});
}

/// Check the publishers once a second.
void GateRunner::check_publishers()
{
  check_.schedule(steady_now() + CHECK_PERIOD);
  owner_.check_publishers();
}

/// Advance the gate to the present.
void GateRunner::advance()
{
  gate_.advance(now());
  settle();
}

}  // namespace deros_runtime_cpp
