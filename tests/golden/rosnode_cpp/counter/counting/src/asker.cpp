// Copyright and licence: see package.xml.

// The node asker: yours to fill in. deros wrote this file once and leaves it alone.

#include "counting/asker.hpp"

#include "rclcpp_components/register_node_macro.hpp"

namespace counting
{

Asker::Asker(const rclcpp::NodeOptions & options)
: AskerBase(options)
{
}

/// Handle a message on ask.
void Asker::on_ask(const std_msgs::msg::Int32 & /*msg*/)
{
  RCLCPP_WARN_ONCE(get_logger(), "on_ask does nothing yet");
}

}  // namespace counting

RCLCPP_COMPONENTS_REGISTER_NODE(counting::Asker)
