// Copyright and licence: see package.xml.

#ifndef DEROS_RUNTIME_CPP__PROCESS_HPP_
#define DEROS_RUNTIME_CPP__PROCESS_HPP_

#include <exception>
#include <functional>
#include <memory>
#include <utility>

#include "rclcpp/rclcpp.hpp"

namespace deros_runtime_cpp
{

/// A node with its own thread, as its program uses it.
struct RunnableNode
{
  using WhenEnded = std::function<void (std::function<void()>)>;

  rclcpp::Node::SharedPtr node;
  WhenEnded when_ended;  // registers a function that is called when the thread ends
  std::function<void()> stop;  // stops the thread, and waits for it
  std::function<std::exception_ptr()> failure;  // the exception that ended the thread, if one did
};

/// Run a node until SIGINT or SIGTERM, or until it ends by itself; return the exit code.
/**
 * An exception ends the program with its text and exit code 1: a node that has stopped watching
 * must not keep sending heartbeats. So do exit() and a shutdown of the context within the node,
 * which would otherwise look like a requested end. No signal interrupts what the node is doing.
 */
int run(int argc, char ** argv, const std::function<RunnableNode()> & make);

/// Run a node of a class that has the functions of RunnableNode.
template<typename NodeT>
int run(int argc, char ** argv)
{
  return run(
    argc, argv, [] {
      const auto node = std::make_shared<NodeT>(rclcpp::NodeOptions());
      return RunnableNode{
        node,
        [node](std::function<void()> ended) {node->when_ended(std::move(ended));},
        [node] {node->stop();},
        [node] {return node->failure();},
      };
    });
}

}  // namespace deros_runtime_cpp

#endif  // DEROS_RUNTIME_CPP__PROCESS_HPP_
