// Copyright and licence: see package.xml.

// The node listener: yours to fill in. deros wrote this file once and leaves it alone.

#include "chat/listener.hpp"

#include "rclcpp_components/register_node_macro.hpp"

namespace chat
{

Listener::Listener(const rclcpp::NodeOptions & options)
: ListenerBase(options)
{
}

/// Handle a message on chatter.
void Listener::on_chatter(const std_msgs::msg::String & /*msg*/)
{
  RCLCPP_WARN_ONCE(get_logger(), "on_chatter does nothing yet");
}

}  // namespace chat

RCLCPP_COMPONENTS_REGISTER_NODE(chat::Listener)
