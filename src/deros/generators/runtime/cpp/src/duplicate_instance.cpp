// Copyright and licence: see package.xml.

#include "deros_runtime_cpp/duplicate_instance.hpp"

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "deros_runtime_cpp/endpoints.hpp"
#include "deros_runtime_cpp/publishers.hpp"
#include "deros_runtime_cpp/refusal.hpp"
#include "deros_runtime_cpp/text.hpp"

namespace deros_runtime_cpp
{

DuplicateInstanceDetector::DuplicateInstanceDetector(
  rclcpp::Node & node, std::string heartbeat, Report report)
: node_(node),
  heartbeat_(std::move(heartbeat)),
  report_(std::move(report)),
  order_(steady_now())
{
}

void DuplicateInstanceDetector::check()
{
  check_heartbeat();
  check_subscriptions();
  if (states_.empty()) {
    return;
  }
  const std::string & topic = states_[next_];
  next_ = (next_ + 1) % states_.size();
  const std::string names = others(topic);
  report_(
    topic, names.empty() ? "" :
    "published by " + names + ", too: its subscribers cannot tell them apart");
}

void DuplicateInstanceDetector::check_heartbeat()
{
  const bool has_double = node_.count_publishers(heartbeat_) > 1;
  const std::string text =
    "another node publishes this heartbeat: its subscribers cannot tell them apart";
  if (order_.gives_way(has_double, steady_now())) {
    throw Refusal(heartbeat_ + ": " + text + "; this one started last and ends now");
  }
  report_(heartbeat_, has_double ? text : "");
}

/// Check the subscriptions of the next topic.
void DuplicateInstanceDetector::check_subscriptions()
{
  const std::string & topic = next_checked_ == 0 ? heartbeat_ : states_[next_checked_ - 1];
  next_checked_ = (next_checked_ + 1) % (states_.size() + 1);
  report_("readers of " + topic, unmatched_subscriptions(node_, topic));
}

/// Return the names of the other nodes that publish a topic.
std::string DuplicateInstanceDetector::others(const std::string & topic) const
{
  if (node_.count_publishers(topic) <= 1) {
    return "";
  }
  std::vector<std::string> names;
  for (const rclcpp::TopicEndpointInfo & info : node_.get_publishers_info_by_topic(topic)) {
    const std::string name = node_of(info);
    if (name != node_.get_fully_qualified_name()) {
      names.push_back(name.empty() ? "a node that is not known yet" : name);
    }
  }
  std::sort(names.begin(), names.end());
  return joined(names, ", ");
}

}  // namespace deros_runtime_cpp
