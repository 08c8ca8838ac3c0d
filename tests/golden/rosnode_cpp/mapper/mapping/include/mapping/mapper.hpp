// Copyright and licence: see package.xml.

// The node mapper: yours to fill in. deros wrote this file once and leaves it alone.

#ifndef MAPPING__MAPPER_HPP_
#define MAPPING__MAPPER_HPP_

#include "mapping/mapper_base.hpp"
#include "rclcpp/rclcpp.hpp"
#include "rclcpp_action/rclcpp_action.hpp"
#include "std_msgs/msg/string.hpp"
#include "std_srvs/srv/trigger.hpp"
#include "test_msgs/action/fibonacci.hpp"

namespace mapping
{

/// Publishes and subscribes one name.
class Mapper : public MapperBase
{
public:
  /// Start the node; everything must be ready before the first handler runs.
  explicit Mapper(const rclcpp::NodeOptions & options);

protected:
  void on_map(const std_msgs::msg::String & msg) override;
  void handle_map(
    const std_srvs::srv::Trigger::Request & request,
    std_srvs::srv::Trigger::Response & response) override;
  void execute_count(
    rclcpp_action::ServerGoalHandle<test_msgs::action::Fibonacci> & goal_handle) override;
};

}  // namespace mapping

#endif  // MAPPING__MAPPER_HPP_
