// Copyright and licence: see package.xml.

// The node dock: yours to fill in. deros wrote this file once and leaves it alone.

#ifndef DOCKING__DOCK_HPP_
#define DOCKING__DOCK_HPP_

#include "docking/dock_base.hpp"
#include "example_interfaces/action/fibonacci.hpp"
#include "rclcpp/rclcpp.hpp"
#include "rclcpp_action/rclcpp_action.hpp"
#include "rosgraph_msgs/msg/clock.hpp"

namespace docking
{

/// The node dock.
class Dock : public DockBase
{
public:
  /// Start the node; everything must be ready before the first handler runs.
  explicit Dock(const rclcpp::NodeOptions & options);

protected:
  void on_clock(const rosgraph_msgs::msg::Clock & msg) override;
  void execute_dock(
    rclcpp_action::ServerGoalHandle<example_interfaces::action::Fibonacci> & goal_handle) override;
};

}  // namespace docking

#endif  // DOCKING__DOCK_HPP_
