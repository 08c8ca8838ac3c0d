// Copyright and licence: see package.xml.

// The node counter: yours to fill in. deros wrote this file once and leaves it alone.

#ifndef COUNTING__COUNTER_HPP_
#define COUNTING__COUNTER_HPP_

#include "counting/counter_base.hpp"
#include "rclcpp/rclcpp.hpp"
#include "rclcpp_action/rclcpp_action.hpp"
#include "std_msgs/msg/empty.hpp"
#include "test_msgs/action/fibonacci.hpp"

namespace counting
{

/// Counts as far as it is asked to.
class Counter : public CounterBase
{
public:
  /// Start the node; everything must be ready before the first handler runs.
  explicit Counter(const rclcpp::NodeOptions & options);

protected:
  void on_release(const std_msgs::msg::Empty & msg) override;
  void execute_count(
    rclcpp_action::ServerGoalHandle<test_msgs::action::Fibonacci> & goal_handle) override;
};

}  // namespace counting

#endif  // COUNTING__COUNTER_HPP_
