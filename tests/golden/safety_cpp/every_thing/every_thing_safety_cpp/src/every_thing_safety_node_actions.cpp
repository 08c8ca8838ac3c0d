… 5 lines as in every_thing_safety_node_actions.hpp: // Copyright and licence: see package.xml.
#include "every_thing_safety_cpp/every_thing_safety_node_actions.hpp"

namespace every_thing_safety_cpp
{

// void EveryThingSafetyNodeActions::release(...)
// {
//   RCLCPP_INFO(node().get_logger(), "the action release is carried out");
// }

}  // namespace every_thing_safety_cpp
