// Copyright and licence: see package.xml.

// The node odometry_node: yours to fill in. deros wrote this file once and leaves it alone.

#ifndef DIFFERENTIAL_ODOMETRY__ODOMETRY_NODE_HPP_
#define DIFFERENTIAL_ODOMETRY__ODOMETRY_NODE_HPP_

#include "differential_odometry/odometry_node_base.hpp"
#include "rclcpp/rclcpp.hpp"
#include "sensor_msgs/msg/imu.hpp"
#include "sensor_msgs/msg/laser_scan.hpp"
#include "std_msgs/msg/int32.hpp"
#include "std_srvs/srv/trigger.hpp"

namespace differential_odometry
{

/// Turns encoder ticks into odometry.
class OdometryNode : public OdometryNodeBase
{
public:
  /// Start the node; everything must be ready before the first handler runs.
  explicit OdometryNode(const rclcpp::NodeOptions & options);

protected:
  void on_ticks(const std_msgs::msg::Int32 & msg) override;
  void on_imu(const sensor_msgs::msg::Imu & msg) override;
  void on_scan(const sensor_msgs::msg::LaserScan & msg) override;
  void on_control() override;
  void handle_reset(
    const std_srvs::srv::Trigger::Request & request,
    std_srvs::srv::Trigger::Response & response) override;
};

}  // namespace differential_odometry

#endif  // DIFFERENTIAL_ODOMETRY__ODOMETRY_NODE_HPP_
