// Copyright and licence: see package.xml.

#ifndef DEROS_RUNTIME_CPP__PUBLISHERS_HPP_
#define DEROS_RUNTIME_CPP__PUBLISHERS_HPP_

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

#include "rclcpp/rclcpp.hpp"

namespace deros_runtime_cpp
{

/// Return the fully qualified name of the node of a publisher; empty if it is not known yet.
std::string node_of(const rclcpp::TopicEndpointInfo & info);

/// What a subscription hears.
struct SubscribedTopic
{
  std::string name;  // fully qualified
  std::string type;
  rclcpp::QoS qos;
};

/// Return the publishers whose messages a subscription gets, as far as the graph knows.
std::vector<rclcpp::TopicEndpointInfo> heard_publishers(
  const rclcpp::Node & node, const SubscribedTopic & topic);

/// Return which subscriptions of a topic get nothing from this node, and why.
std::string unserved_readers(const rclcpp::Node & node, const std::string & topic);

/// Looks, one topic at a time, at the publishers on the topics that a node subscribes to.
/**
 * Those of another type or of an unfit quality of service cannot be heard: the middleware keeps
 * silent about the first, and does not say when the second ends. And where one publisher is
 * expected, a second one contradicts it, or hides that it has died.
 */
class Publishers
{
public:
  /// Takes a topic and what is wrong with it, empty if nothing is.
  using Report = std::function<void (const std::string &, const std::string &)>;

  Publishers(rclcpp::Node & node, Report report);

  /// MonitorRunner over a topic, on which there may be any number of publishers if it is shared.
  void add(SubscribedTopic topic, bool is_shared = false);
  void add(
    const rclcpp::SubscriptionBase & subscription, const std::string & type,
    bool is_shared = false)
  {
    add({subscription.get_topic_name(), type, subscription.get_actual_qos()}, is_shared);
  }

  /// Look at the next topic.
  void look();

private:
  struct Topic
  {
    SubscribedTopic subscribed;
    bool is_shared;
  };

  std::string faults(const Topic & topic) const;

  rclcpp::Node & node_;
  Report report_;
  std::vector<Topic> topics_;
  std::size_t next_ = 0;
};

}  // namespace deros_runtime_cpp

#endif  // DEROS_RUNTIME_CPP__PUBLISHERS_HPP_
