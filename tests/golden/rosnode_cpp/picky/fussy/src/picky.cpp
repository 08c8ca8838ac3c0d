// Copyright and licence: see package.xml.

// The node picky: yours to fill in. deros wrote this file once and leaves it alone.

#include "fussy/picky.hpp"

#include "rclcpp_components/register_node_macro.hpp"

namespace fussy
{

Picky::Picky(const rclcpp::NodeOptions & options)
: PickyBase(options)
{
}

/// Handle a message on class.
void Picky::on_class_(const std_msgs::msg::Empty & /*msg*/)
{
  RCLCPP_WARN_ONCE(get_logger(), "on_class_ does nothing yet");
}

/// Handle a message on imu.
///
/// The parameter imu_topic gives the topic's name at start.
void Picky::on_imu(const sensor_msgs::msg::Imu & /*msg*/)
{
  RCLCPP_WARN_ONCE(get_logger(), "on_imu does nothing yet");
}

/// Handle a message on scan.
void Picky::on_scan(const sensor_msgs::msg::LaserScan & /*msg*/)
{
  RCLCPP_WARN_ONCE(get_logger(), "on_scan does nothing yet");
}

/// Handle a message on range.
///
/// One for each sensor.
///
/// The parameter ranges lists the topics at start.
void Picky::on_range(const sensor_msgs::msg::Range & /*msg*/)
{
  RCLCPP_WARN_ONCE(get_logger(), "on_range does nothing yet");
}

/// Run every 60 s.
///
/// Ticks.
void Picky::on_while_()
{
  RCLCPP_WARN_ONCE(get_logger(), "on_while_ does nothing yet");
}

/// Answer a request to struct: fill in the response.
void Picky::handle_struct_(
  const std_srvs::srv::SetBool::Request & /*request*/,
  std_srvs::srv::SetBool::Response & /*response*/)
{
  RCLCPP_WARN_ONCE(get_logger(), "handle_struct_ does nothing yet");
}

}  // namespace fussy

RCLCPP_COMPONENTS_REGISTER_NODE(fussy::Picky)
