// The QoS of the safety node's topics.

#ifndef QOS_HPP_
#define QOS_HPP_

#include "rclcpp/qos.hpp"

/// As the safety node subscribes.
inline rclcpp::QoS imu_qos()
{
  return rclcpp::QoS(10).best_effort();
}

/// As the safety node publishes the state of an action.
inline rclcpp::QoS state_qos()
{
  return rclcpp::QoS(1).reliable().transient_local();
}

/// For events: none is to be lost while the driver has something else to do.
inline rclcpp::QoS record_qos()
{
  return rclcpp::QoS(1000).reliable();
}

#endif  // QOS_HPP_
