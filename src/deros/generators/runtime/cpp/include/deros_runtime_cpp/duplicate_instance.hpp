// Copyright and licence: see package.xml.

#ifndef DEROS_RUNTIME_CPP__DUPLICATE_INSTANCE_HPP_
#define DEROS_RUNTIME_CPP__DUPLICATE_INSTANCE_HPP_

#include <cstddef>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "deros_runtime_cpp/start_order.hpp"
#include "rclcpp/rclcpp.hpp"

namespace deros_runtime_cpp
{

/// Checks that no other node publishes the heartbeat of a node, or the states of its actions.
/**
 * Another publisher of the heartbeat is a second node of the same name, on another machine or
 * without a common folder for temporary files; another publisher of states contradicts the node.
 * It also checks that every subscription of these topics is compatible with the node's publisher.
 */
class DuplicateInstanceDetector
{
public:
  /// Takes a topic and its fault; an empty text if there is none.
  using Report = std::function<void (const std::string &, const std::string &)>;

  DuplicateInstanceDetector(rclcpp::Node & node, std::string heartbeat, Report report);

  /// Add a topic with states.
  void add(std::string topic)
  {
    states_.push_back(std::move(topic));
  }

  /// Check now. \throw Refusal if there is a second node and this one started last
  void check();

private:
  void check_heartbeat();
  void check_subscriptions();
  std::string others(const std::string & topic) const;

  rclcpp::Node & node_;
  std::string heartbeat_;
  std::vector<std::string> states_;
  std::size_t next_ = 0;
  std::size_t next_checked_ = 0;
  Report report_;
  StartOrder order_;
};

}  // namespace deros_runtime_cpp

#endif  // DEROS_RUNTIME_CPP__DUPLICATE_INSTANCE_HPP_
