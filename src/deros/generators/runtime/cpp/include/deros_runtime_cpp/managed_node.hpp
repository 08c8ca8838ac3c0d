// Copyright and licence: see package.xml.

/// \file
/// What a managed node needs beside what rclcpp_lifecycle has.

#ifndef DEROS_RUNTIME_CPP__MANAGED_NODE_HPP_
#define DEROS_RUNTIME_CPP__MANAGED_NODE_HPP_

#include "rclcpp_lifecycle/lifecycle_node.hpp"

namespace deros_runtime_cpp
{

/// Have publishers, handlers and timers of a node rest unless it is active, however it left.
/**
 * rclcpp deactivates them in on_deactivate() alone: not when the node is shut down while it is
 * active, nor when a hook that activates or deactivates it throws or fails.
 */
void rest_unless_active(rclcpp_lifecycle::LifecycleNode & node);

}  // namespace deros_runtime_cpp

#endif  // DEROS_RUNTIME_CPP__MANAGED_NODE_HPP_
