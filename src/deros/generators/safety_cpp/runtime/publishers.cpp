#include "deros_runtime/runtime/publishers.hpp"

#include <algorithm>
#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "deros_runtime/runtime/text.hpp"

namespace deros_runtime
{

namespace
{

/// Return the reason without the middleware's decoration.
std::string bare(std::string reason)
{
  const std::string mark = "ERROR: ";
  if (reason.compare(0, mark.size(), mark) == 0) {
    reason.erase(0, mark.size());
  }
  reason.erase(0, std::min(reason.find_first_not_of(" ;"), reason.size()));
  reason.erase(reason.find_last_not_of(" ;") + 1);
  return reason;
}

/// Return why a subscription does not hear a publisher; empty if it does.
std::string unheard(const rclcpp::TopicEndpointInfo & info, const SubscribedTopic & topic)
{
  if (info.topic_type() != topic.type) {
    return "publishes " + info.topic_type() + " on it, which is not heard";
  }
  const auto fit = rclcpp::qos_check_compatible(info.qos_profile(), topic.qos);
  if (fit.compatibility == rclcpp::QoSCompatibility::Error) {
    return "offers a QoS on it that is not heard: " + bare(fit.reason);
  }
  return "";
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

}  // namespace deros_runtime
