// Copyright and licence: see package.xml.

// The node odometry_node: yours to fill in. deros wrote this file once and leaves it alone.

#include "differential_odometry/odometry_node.hpp"

#include "rclcpp_components/register_node_macro.hpp"

namespace differential_odometry
{

OdometryNode::OdometryNode(const rclcpp::NodeOptions & options)
: OdometryNodeBase(options)
{
}

/// Handle a message on ticks.
void OdometryNode::on_ticks(const std_msgs::msg::Int32 & /*msg*/)
{
  RCLCPP_WARN_ONCE(get_logger(), "on_ticks does nothing yet");
}

/// Handle a message on imu.
///
/// The parameter imu_topic gives the topic's name at start.
void OdometryNode::on_imu(const sensor_msgs::msg::Imu & /*msg*/)
{
  RCLCPP_WARN_ONCE(get_logger(), "on_imu does nothing yet");
}

/// Handle a message on scan.
void OdometryNode::on_scan(const sensor_msgs::msg::LaserScan & /*msg*/)
{
  RCLCPP_WARN_ONCE(get_logger(), "on_scan does nothing yet");
}

/// Run every 20 ms.
///
/// Integrates the ticks.
void OdometryNode::on_control()
{
  RCLCPP_WARN_ONCE(get_logger(), "on_control does nothing yet");
}

/// Answer a request to reset: fill in the response.
void OdometryNode::handle_reset(
  const std_srvs::srv::Trigger::Request & /*request*/,
  std_srvs::srv::Trigger::Response & /*response*/)
{
  RCLCPP_WARN_ONCE(get_logger(), "handle_reset does nothing yet");
}

}  // namespace differential_odometry

RCLCPP_COMPONENTS_REGISTER_NODE(differential_odometry::OdometryNode)
