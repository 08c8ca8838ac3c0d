// Copyright and licence: see package.xml.

#include "deros_runtime_cpp/publishers.hpp"

#include <algorithm>
#include <cstddef>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "deros_runtime_cpp/text.hpp"

namespace deros_runtime_cpp
{

namespace
{

/// Return why the middleware does not connect a publisher with a subscription; empty if it does.
std::string incompatible(const rclcpp::QoS & offered, const rclcpp::QoS & requested)
{
  const auto fit = rclcpp::qos_check_compatible(offered, requested);
  if (fit.compatibility != rclcpp::QoSCompatibility::Error) {
    return "";
  }
  const std::string mark = "ERROR: ";
  std::vector<std::string> reasons;
  std::istringstream parts(fit.reason);
  for (std::string part; std::getline(parts, part, ';'); ) {
    if (const std::size_t at = part.find(mark); at != std::string::npos) {
      reasons.push_back(part.substr(at + mark.size()));
    }
  }
  return joined(reasons, "; ");
}

/// Return why a subscription does not hear a publisher; empty if it does.
std::string unheard(const rclcpp::TopicEndpointInfo & info, const SubscribedTopic & topic)
{
  if (info.topic_type() != topic.type) {
    return "publishes " + info.topic_type() + " on it, which is not heard";
  }
  const std::string reason = incompatible(info.qos_profile(), topic.qos);
  return reason.empty() ? "" : "offers a QoS on it that is not heard: " + reason;
}

/// Return why a publisher does not reach a subscription; empty if it does.
std::string unserved(
  const rclcpp::TopicEndpointInfo & offer, const rclcpp::TopicEndpointInfo & reader)
{
  if (reader.topic_type() != offer.topic_type()) {
    return "subscribes to " + reader.topic_type() + " on it, which is not published";
  }
  const std::string reason = incompatible(offer.qos_profile(), reader.qos_profile());
  return reason.empty() ? "" : "asks for a QoS on it that is not offered: " + reason;
}

}  // namespace

std::string node_of(const rclcpp::TopicEndpointInfo & info)
{
  // What the middleware calls a node of which it knows no more yet.
  if (info.node_name().empty() || info.node_name() == "_NODE_NAME_UNKNOWN_") {
    return "";
  }
  const std::string & space = info.node_namespace();
  return (space == "/" ? "" : space) + '/' + info.node_name();
}

std::vector<rclcpp::TopicEndpointInfo> heard_publishers(
  const rclcpp::Node & node, const SubscribedTopic & topic)
{
  std::vector<rclcpp::TopicEndpointInfo> infos = node.get_publishers_info_by_topic(topic.name);
  infos.erase(
    std::remove_if(
      infos.begin(), infos.end(),
      [&topic](const auto & each) {return !unheard(each, topic).empty();}),
    infos.end());
  return infos;
}

std::string unserved_readers(const rclcpp::Node & node, const std::string & topic)
{
  const std::vector<rclcpp::TopicEndpointInfo> offers = node.get_publishers_info_by_topic(topic);
  const auto offer = std::find_if(
    offers.begin(), offers.end(),
    [&node](const auto & each) {return node_of(each) == node.get_fully_qualified_name();});
  if (offer == offers.end()) {
    return "";
  }
  std::vector<std::string> found;
  for (const rclcpp::TopicEndpointInfo & info : node.get_subscriptions_info_by_topic(topic)) {
    const std::string reason = unserved(*offer, info);
    if (reason.empty()) {
      continue;
    }
    const std::string name = node_of(info);
    const std::string fault = (name.empty() ? info.node_name() : name) + ' ' + reason;
    if (std::find(found.begin(), found.end(), fault) == found.end()) {
      found.push_back(fault);
    }
  }
  return joined(found, "; ");
}

Publishers::Publishers(rclcpp::Node & node, Report report)
: node_(node), report_(std::move(report))
{
}

void Publishers::add(SubscribedTopic topic, bool is_shared)
{
  topics_.push_back({std::move(topic), is_shared});
}

void Publishers::look()
{
  if (topics_.empty()) {
    return;
  }
  const Topic & topic = topics_[next_];
  next_ = (next_ + 1) % topics_.size();
  report_(topic.subscribed.name, faults(topic));
}

std::string Publishers::faults(const Topic & topic) const
{
  std::vector<std::string> found;
  std::vector<std::string> heard;
  const std::string & on = topic.subscribed.name;
  for (const rclcpp::TopicEndpointInfo & info : node_.get_publishers_info_by_topic(on)) {
    const std::string name = node_of(info);
    const std::string reason = unheard(info, topic.subscribed);
    if (reason.empty()) {
      heard.push_back(name.empty() ? "a node that is not known yet" : name);
      continue;
    }
    const std::string fault = (name.empty() ? info.node_name() : name) + ' ' + reason;
    if (std::find(found.begin(), found.end(), fault) == found.end()) {
      found.push_back(fault);
    }
  }
  if (heard.size() > 1 && !topic.is_shared) {
    std::sort(heard.begin(), heard.end());
    found.push_back(
      std::to_string(heard.size()) + " publishers where one is expected: " + joined(heard, ", "));
  }
  return joined(found, "; ");
}

}  // namespace deros_runtime_cpp
