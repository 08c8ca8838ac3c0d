// Copyright and licence: see package.xml.

// The node valve: yours to fill in. deros wrote this file once and leaves it alone.

#ifndef PROCESS__VALVE_HPP_
#define PROCESS__VALVE_HPP_

#include "process/valve_base.hpp"
#include "rclcpp/rclcpp.hpp"
#include "std_msgs/msg/bool.hpp"

namespace process
{

/// Opens and closes a valve.
class Valve : public ValveBase
{
public:
  /// Start the node; everything must be ready before the first handler runs.
  explicit Valve(const rclcpp::NodeOptions & options);

protected:
  void on_command(const std_msgs::msg::Bool & msg) override;
  void on_report() override;
};

}  // namespace process

#endif  // PROCESS__VALVE_HPP_
