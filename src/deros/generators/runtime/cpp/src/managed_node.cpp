// Copyright and licence: see package.xml.

#include "deros_runtime_cpp/managed_node.hpp"

#include <algorithm>
#include <functional>
#include <vector>

namespace deros_runtime_cpp
{

namespace
{

using rclcpp_lifecycle::LifecycleNode;
using rclcpp_lifecycle::State;
using Hooks = rclcpp_lifecycle::node_interfaces::LifecycleNodeInterface;
using Result = Hooks::CallbackReturn;
using Hook = std::function<Result (const State &)>;

/// Return a hook that deactivates what the node manages, unless its result is one of some.
Hook resting(
  LifecycleNode & node, Result (Hooks::* hook)(const State &), std::vector<Result> unless)
{
  return [&node, hook, unless](const State & previous) {
           try {
             const Result result = (node.*hook)(previous);
             if (std::find(unless.begin(), unless.end(), result) == unless.end()) {
               node.LifecycleNode::on_deactivate(previous);
             }
             return result;
           } catch (...) {
             node.LifecycleNode::on_deactivate(previous);
             throw;
           }
         };
}

}  // namespace

void rest_unless_active(LifecycleNode & node)
{
  node.register_on_activate(resting(node, &Hooks::on_activate, {Result::SUCCESS}));
  // The hook itself deactivates if it succeeds; if it fails, the node stays active.
  node.register_on_deactivate(
    resting(node, &Hooks::on_deactivate, {Result::SUCCESS, Result::FAILURE}));
  node.register_on_shutdown(resting(node, &Hooks::on_shutdown, {}));
}

}  // namespace deros_runtime_cpp
