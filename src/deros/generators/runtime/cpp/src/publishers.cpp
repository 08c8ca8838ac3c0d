// Copyright and licence: see package.xml.

#include "deros_runtime_cpp/publishers.hpp"

#include <algorithm>
#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "deros_runtime_cpp/endpoints.hpp"
#include "deros_runtime_cpp/text.hpp"

namespace deros_runtime_cpp
{

namespace
{

constexpr const char * DIED =
  " (one that died counts until the middleware forgets it: 20 s with Fast DDS)";

/// Return why a publisher does not match a subscription of this node; empty if it does.
std::string mismatch(const rclcpp::TopicEndpointInfo & info, const SubscribedTopic & topic)
{
  if (info.topic_type() != topic.type) {
    return "publishes " + info.topic_type() + " on it, which is not received";
  }
  const std::string reason = incompatibility(info.qos_profile(), topic.qos);
  return reason.empty() ? "" : "offers an incompatible QoS on it: " + reason;
}

/// Return why a subscription does not match the publisher of this node; empty if it does.
std::string mismatch(
  const rclcpp::TopicEndpointInfo & offer, const rclcpp::TopicEndpointInfo & subscription)
{
  if (subscription.topic_type() != offer.topic_type()) {
    return "subscribes to " + subscription.topic_type() + " on it, which is not published";
  }
  const std::string reason = incompatibility(offer.qos_profile(), subscription.qos_profile());
  return reason.empty() ? "" : "asks for a QoS on it that is not offered: " + reason;
}

}  // namespace

std::vector<rclcpp::TopicEndpointInfo> matched_publishers(
  const rclcpp::Node & node, const SubscribedTopic & topic)
{
  std::vector<rclcpp::TopicEndpointInfo> infos = node.get_publishers_info_by_topic(topic.name);
  infos.erase(
    std::remove_if(
      infos.begin(), infos.end(),
      [&topic](const auto & each) {return !mismatch(each, topic).empty();}),
    infos.end());
  return infos;
}

std::string unmatched_subscriptions(const rclcpp::Node & node, const std::string & topic)
{
  const std::vector<rclcpp::TopicEndpointInfo> offers = node.get_publishers_info_by_topic(topic);
  const auto offer = std::find_if(
    offers.begin(), offers.end(),
    [&node](const auto & each) {return node_of(each) == node.get_fully_qualified_name();});
  if (offer == offers.end()) {
    return "";
  }
  std::vector<std::string> faults;
  for (const rclcpp::TopicEndpointInfo & info : node.get_subscriptions_info_by_topic(topic)) {
    const std::string reason = mismatch(*offer, info);
    if (reason.empty()) {
      continue;
    }
    const std::string name = node_of(info);
    const std::string fault = (name.empty() ? info.node_name() : name) + ' ' + reason;
    if (std::find(faults.begin(), faults.end(), fault) == faults.end()) {
      faults.push_back(fault);
    }
  }
  return joined(faults, "; ");
}

PublisherCheck::PublisherCheck(rclcpp::Node & node, Report report)
: node_(node), report_(std::move(report))
{
}

void PublisherCheck::add(SubscribedTopic topic, bool is_shared, const std::string & key)
{
  topics_.push_back({std::move(topic), is_shared, key, false});
}

void PublisherCheck::check()
{
  if (topics_.empty()) {
    return;
  }
  for (Topic & topic : topics_) {
    if (!topic.key.empty()) {
      check(topic);
    }
  }
  Topic & topic = topics_[next_];
  next_ = (next_ + 1) % topics_.size();
  if (topic.key.empty()) {
    check(topic);
  }
}

void PublisherCheck::check(Topic & topic)
{
  report_(topic.subscribed.name, faults(topic));
}

bool PublisherCheck::has_one_publisher(const std::string & key) const
{
  return std::none_of(
    topics_.begin(), topics_.end(),
    [&key](const Topic & topic) {return topic.key == key && topic.is_crowded;});
}

std::string PublisherCheck::faults(Topic & topic) const
{
  std::vector<std::string> faults;
  std::vector<std::string> matched;
  std::vector<std::string> known;  // those of them whose nodes are known
  const std::string & on = topic.subscribed.name;
  for (const rclcpp::TopicEndpointInfo & info : node_.get_publishers_info_by_topic(on)) {
    const std::string reason = mismatch(info, topic.subscribed);
    const std::string name = node_of(info);
    if (reason.empty()) {
      matched.push_back(shown_node_of(info));
      if (!name.empty()) {
        known.push_back(name);
      }
      continue;
    }
    const std::string fault = (name.empty() ? info.node_name() : name) + ' ' + reason;
    if (std::find(faults.begin(), faults.end(), fault) == faults.end()) {
      faults.push_back(fault);
    }
  }
  topic.is_crowded = matched.size() > 1;
  if (topic.is_crowded && !topic.is_shared) {
    std::sort(matched.begin(), matched.end());
    const std::string count = std::to_string(matched.size());
    std::sort(known.begin(), known.end());
    const bool is_twice = std::adjacent_find(known.begin(), known.end()) != known.end();
    faults.push_back(
      count + " publishers where one is expected: " + joined(matched, ", ") +
      (is_twice ? DIED : ""));
  }
  return joined(faults, "; ");
}

}  // namespace deros_runtime_cpp
