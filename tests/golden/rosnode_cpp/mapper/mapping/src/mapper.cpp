// Copyright and licence: see package.xml.

// The node mapper: yours to fill in. deros wrote this file once and leaves it alone.

#include "mapping/mapper.hpp"

#include <memory>

#include "rclcpp_components/register_node_macro.hpp"

namespace mapping
{

Mapper::Mapper(const rclcpp::NodeOptions & options)
: MapperBase(options)
{
}

/// Handle a message on map.
void Mapper::on_map(const std_msgs::msg::String & /*msg*/)
{
  RCLCPP_WARN_ONCE(get_logger(), "on_map does nothing yet");
}

/// Answer a request to map: fill in the response.
void Mapper::handle_map(
  const std_srvs::srv::Trigger::Request & /*request*/,
  std_srvs::srv::Trigger::Response & /*response*/)
{
  RCLCPP_WARN_ONCE(get_logger(), "handle_map does nothing yet");
}

/// Execute a goal of count, in a thread of its own: succeed, abort or cancel it. Return soon when
/// is_executing() is false: a cancel was accepted, or the node ends.
void Mapper::execute_count(
  rclcpp_action::ServerGoalHandle<test_msgs::action::Fibonacci> & goal_handle)
{
  RCLCPP_WARN_ONCE(get_logger(), "execute_count does nothing yet");
  goal_handle.abort(std::make_shared<test_msgs::action::Fibonacci::Result>());
}

}  // namespace mapping

RCLCPP_COMPONENTS_REGISTER_NODE(mapping::Mapper)
