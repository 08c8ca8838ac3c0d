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

/// A node with a thread of its own, as its program sees it.
struct Living
{
  using WhenEnded = std::function<void (std::function<void()>)>;

  rclcpp::Node::SharedPtr node;
  WhenEnded when_ended;  // has a function called at the end
  std::function<void()> stop;  // ends the thread, and waits for that
  std::function<std::exception_ptr()> failure;  // what ended the thread, if something was thrown
};

/// Run a node until SIGINT or SIGTERM, or until it ends by itself; return the exit code.
/**
 * What is thrown ends the program with its text and exit code 1: a node that does not watch any
 * more must not go on saying that it does. So do exit() and a shutdown of the context within the
 * node, which would else look as if it had been told to end. No signal breaks what the node is at.
 */
int run(int argc, char ** argv, const std::function<Living()> & make);

/// Run a node of a class that has the functions of Living.
template<typename NodeT>
int run(int argc, char ** argv)
{
  return run(
    argc, argv, [] {
      const auto node = std::make_shared<NodeT>(rclcpp::NodeOptions());
      return Living{
        node,
        [node](std::function<void()> ended) {node->when_ended(std::move(ended));},
        [node] {node->stop();},
        [node] {return node->failure();},
      };
    });
}

}  // namespace deros_runtime_cpp

#endif  // DEROS_RUNTIME_CPP__PROCESS_HPP_
