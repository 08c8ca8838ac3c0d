// Copyright and licence: see package.xml.

// The node counter: yours to fill in. deros wrote this file once and leaves it alone.

#include "counting/counter.hpp"

#include <memory>

#include "rclcpp_components/register_node_macro.hpp"

namespace counting
{

Counter::Counter(const rclcpp::NodeOptions & options)
: CounterBase(options)
{
}

/// Handle a message on release.
void Counter::on_release(const std_msgs::msg::Empty & /*msg*/)
{
  RCLCPP_WARN_ONCE(get_logger(), "on_release does nothing yet");
}

/// Execute a goal of count, in a thread of its own: succeed, abort or cancel it. Return soon when
/// is_executing() is false: a cancel was accepted, or the node ends.
void Counter::execute_count(
  rclcpp_action::ServerGoalHandle<test_msgs::action::Fibonacci> & goal_handle)
{
  RCLCPP_WARN_ONCE(get_logger(), "execute_count does nothing yet");
  goal_handle.abort(std::make_shared<test_msgs::action::Fibonacci::Result>());
}

}  // namespace counting

RCLCPP_COMPONENTS_REGISTER_NODE(counting::Counter)
