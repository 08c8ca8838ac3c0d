// Copyright and licence: see package.xml.

/// \file
/// Complements rclcpp_lifecycle for managed nodes.

#ifndef DEROS_RUNTIME_CPP__MANAGED_NODE_HPP_
#define DEROS_RUNTIME_CPP__MANAGED_NODE_HPP_

#include "rclcpp_lifecycle/lifecycle_node.hpp"

namespace deros_runtime_cpp
{

/// Deactivate the managed entities of a node whenever it leaves the active state.
/**
 * rclcpp_lifecycle deactivates publishers, handlers and timers only in on_deactivate(): not when an
 * active node is shut down, or when a callback that activates or deactivates it throws or fails.
 */
void deactivate_unless_active(rclcpp_lifecycle::LifecycleNode & node);

}  // namespace deros_runtime_cpp

#endif  // DEROS_RUNTIME_CPP__MANAGED_NODE_HPP_
