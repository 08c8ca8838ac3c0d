// Copyright and licence: see package.xml.

// The node asker: yours to fill in. deros wrote this file once and leaves it alone.

#ifndef COUNTING__ASKER_HPP_
#define COUNTING__ASKER_HPP_

#include "counting/asker_base.hpp"
#include "rclcpp/rclcpp.hpp"
#include "std_msgs/msg/int32.hpp"

namespace counting
{

/// The node asker.
class Asker : public AskerBase
{
public:
  /// Start the node; everything must be ready before the first handler runs.
  explicit Asker(const rclcpp::NodeOptions & options);

protected:
  void on_ask(const std_msgs::msg::Int32 & msg) override;
};

}  // namespace counting

#endif  // COUNTING__ASKER_HPP_
