// Copyright and licence: see package.xml.

// The node listener: yours to fill in. deros wrote this file once and leaves it alone.

#ifndef CHAT__LISTENER_HPP_
#define CHAT__LISTENER_HPP_

#include "chat/listener_base.hpp"
#include "rclcpp/rclcpp.hpp"
#include "std_msgs/msg/string.hpp"

namespace chat
{

/// The node listener.
class Listener : public ListenerBase
{
public:
  /// Start the node; everything must be ready before the first handler runs.
  explicit Listener(const rclcpp::NodeOptions & options);

protected:
  void on_chatter(const std_msgs::msg::String & msg) override;
};

}  // namespace chat

#endif  // CHAT__LISTENER_HPP_
