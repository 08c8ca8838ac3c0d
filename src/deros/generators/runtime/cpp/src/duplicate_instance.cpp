// Copyright and licence: see package.xml.

#include "deros_runtime_cpp/duplicate_instance.hpp"

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

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

void DuplicateInstanceDetector::look()
{
  look_at_heartbeat();
  look_at_readers();
  if (states_.empty()) {
    return;
  }
  const std::string & topic = states_[next_];
  next_ = (next_ + 1) % states_.size();
  const std::string found = others(topic);
  report_(
    topic, found.empty() ? "" :
    "published by " + found + ", too: whoever obeys it cannot tell them apart");
}

void DuplicateInstanceDetector::look_at_heartbeat()
{
  const bool has_double = node_.count_publishers(heartbeat_) > 1;
  const std::string text =
    "another node publishes this heartbeat: whoever heeds it cannot tell them apart";
  if (order_.gives_way(has_double, steady_now())) {
    throw Refusal(heartbeat_ + ": " + text + "; this one started last and ends now");
  }
  report_(heartbeat_, has_double ? text : "");
}

/// Look whether whoever subscribes to the next of the topics is served.
void DuplicateInstanceDetector::look_at_readers()
{
  const std::string & topic = next_read_ == 0 ? heartbeat_ : states_[next_read_ - 1];
  next_read_ = (next_read_ + 1) % (states_.size() + 1);
  report_("readers of " + topic, unserved_readers(node_, topic));
}

/// Return the names of the nodes that publish on a topic besides this one.
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
