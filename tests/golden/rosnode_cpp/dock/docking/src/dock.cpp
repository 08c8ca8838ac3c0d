// Copyright and licence: see package.xml.

// The node dock: yours to fill in. deros wrote this file once and leaves it alone.

#include "docking/dock.hpp"

#include <memory>

#include "rclcpp_components/register_node_macro.hpp"

namespace docking
{

Dock::Dock(const rclcpp::NodeOptions & options)
: DockBase(options)
{
}

/// Handle a message on clock.
void Dock::on_clock(const rosgraph_msgs::msg::Clock & /*msg*/)
{
  RCLCPP_WARN_ONCE(get_logger(), "on_clock does nothing yet");
}

/// Execute a goal of dock, in a thread of its own: succeed, abort or cancel it. Return soon when
/// is_executing() is false: a cancel was accepted, or the node ends.
void Dock::execute_dock(
  rclcpp_action::ServerGoalHandle<example_interfaces::action::Fibonacci> & goal_handle)
{
  RCLCPP_WARN_ONCE(get_logger(), "execute_dock does nothing yet");
  goal_handle.abort(std::make_shared<example_interfaces::action::Fibonacci::Result>());
}

}  // namespace docking

RCLCPP_COMPONENTS_REGISTER_NODE(docking::Dock)
