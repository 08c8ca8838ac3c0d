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

/// A topic as a subscription of this node sees it.
struct SubscribedTopic
{
  std::string name;  // fully qualified
  std::string type;
  rclcpp::QoS qos;
};

/// Return the publishers that match a subscription, as far as the graph knows.
std::vector<rclcpp::TopicEndpointInfo> matched_publishers(
  const rclcpp::Node & node, const SubscribedTopic & topic);

/// Return which subscriptions of a topic do not match the publisher of this node, and why.
std::string unmatched_subscriptions(const rclcpp::Node & node, const std::string & topic);

/// Checks the publishers of the topics that a node subscribes to, one topic at a time.
/**
 * Publishers with another type or an incompatible QoS do not match: the middleware does not report
 * the former, and not when the latter end. And where one publisher is expected, a second one
 * contradicts it, or hides that it has died.
 */
class PublisherCheck
{
public:
  /// Takes a topic and its fault; an empty text if there is none.
  using Report = std::function<void (const std::string &, const std::string &)>;

  PublisherCheck(rclcpp::Node & node, Report report);

  /// Add a topic; it may have several publishers if it is shared.
  /**
   * With a key, its values are not known while there are several: it is checked each time, and the
   * key is that of has_one_publisher().
   */
  void add(SubscribedTopic topic, bool is_shared = false, const std::string & key = "");
  void add(
    const rclcpp::SubscriptionBase & subscription, const std::string & type,
    bool is_shared = false, const std::string & key = "")
  {
    add({subscription.get_topic_name(), type, subscription.get_actual_qos()}, is_shared, key);
  }

  /// Check the next topic, and all those with a key.
  void check();

  /// Return whether a topic with a key did not have several publishers when it was checked last.
  bool has_one_publisher(const std::string & key) const;

private:
  struct Topic
  {
    SubscribedTopic subscribed;
    bool is_shared;
    std::string key;
    bool is_crowded;  // when it was checked last
  };

  void check(Topic & topic);
  std::string faults(Topic & topic) const;

  rclcpp::Node & node_;
  Report report_;
  std::vector<Topic> topics_;
  std::size_t next_ = 0;
};

}  // namespace deros_runtime_cpp

#endif  // DEROS_RUNTIME_CPP__PUBLISHERS_HPP_
