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

/// Looks whether somebody else publishes the heartbeat of a node, or the states of its actions.
/**
 * The first is a second node of its name, on another machine or without a common folder for
 * temporary files; the second contradicts it. It also looks whether whoever subscribes to one of
 * these topics is served.
 */
class DuplicateInstanceDetector
{
public:
  /// Takes the topic and what is wrong with it, empty if nothing is.
  using Report = std::function<void (const std::string &, const std::string &)>;

  DuplicateInstanceDetector(rclcpp::Node & node, std::string heartbeat, Report report);

  /// MonitorRunner over a topic with states.
  void add(std::string topic)
  {
    states_.push_back(std::move(topic));
  }

  /// Look now. \throw Refusal if there is a second node and this one started last
  void look();

private:
  void look_at_heartbeat();
  void look_at_readers();
  std::string others(const std::string & topic) const;

  rclcpp::Node & node_;
  std::string heartbeat_;
  std::vector<std::string> states_;
  std::size_t next_ = 0;
  std::size_t next_read_ = 0;
  Report report_;
  StartOrder order_;
};

}  // namespace deros_runtime_cpp

#endif  // DEROS_RUNTIME_CPP__DUPLICATE_INSTANCE_HPP_
