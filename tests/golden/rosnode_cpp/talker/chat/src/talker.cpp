// Copyright and licence: see package.xml.

// The node talker: yours to fill in. deros wrote this file once and leaves it alone.

#include "chat/talker.hpp"

#include "rclcpp_components/register_node_macro.hpp"

namespace chat
{

Talker::Talker(const rclcpp::NodeOptions & options)
: TalkerBase(options)
{
}

}  // namespace chat

RCLCPP_COMPONENTS_REGISTER_NODE(chat::Talker)
