// Copyright and licence: see package.xml.

// The node valve: yours to fill in. deros wrote this file once and leaves it alone.

#include "process/valve.hpp"

#include "rclcpp_components/register_node_macro.hpp"

namespace process
{

Valve::Valve(const rclcpp::NodeOptions & options)
: ValveBase(options)
{
}

/// Handle a message on command.
void Valve::on_command(const std_msgs::msg::Bool & /*msg*/)
{
  RCLCPP_WARN_ONCE(get_logger(), "on_command does nothing yet");
}

/// Run every 50 ms.
void Valve::on_report()
{
  RCLCPP_WARN_ONCE(get_logger(), "on_report does nothing yet");
}

}  // namespace process

RCLCPP_COMPONENTS_REGISTER_NODE(process::Valve)
