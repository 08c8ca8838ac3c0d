// Copyright and licence: see package.xml.

// The node talker: yours to fill in. deros wrote this file once and leaves it alone.

#ifndef CHAT__TALKER_HPP_
#define CHAT__TALKER_HPP_

#include "chat/talker_base.hpp"
#include "rclcpp/rclcpp.hpp"

namespace chat
{

/// Says hello.
class Talker : public TalkerBase
… 3 lines of node.hpp.j2: {
  explicit Talker(const rclcpp::NodeOptions & options);
};

}  // namespace chat

#endif  // CHAT__TALKER_HPP_
