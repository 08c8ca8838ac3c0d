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
using Callbacks = rclcpp_lifecycle::node_interfaces::LifecycleNodeInterface;
using Result = Callbacks::CallbackReturn;
using Callback = std::function<Result (const State &)>;

/// Return a callback that deactivates the managed entities, unless it returns one of some results.
Callback deactivating(
  LifecycleNode & node, Result (Callbacks::* callback)(const State &), std::vector<Result> unless)
{
  return [&node, callback, unless](const State & previous) {
           try {
             const Result result = (node.*callback)(previous);
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

void deactivate_unless_active(LifecycleNode & node)
{
  node.register_on_activate(deactivating(node, &Callbacks::on_activate, {Result::SUCCESS}));
  // The callback itself deactivates them on success; on failure, the node stays active.
  node.register_on_deactivate(
    deactivating(node, &Callbacks::on_deactivate, {Result::SUCCESS, Result::FAILURE}));
  node.register_on_shutdown(deactivating(node, &Callbacks::on_shutdown, {}));
}

}  // namespace deros_runtime_cpp
