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

}  // namespace

Publishers::Publishers(rclcpp::Node & node, Report report)
: node_(node), report_(std::move(report))
{
}

void Publishers::add(const rclcpp::SubscriptionBase & subscription, const std::string & type)
{
  topics_.push_back({subscription.get_topic_name(), type, subscription.get_actual_qos()});
}

void Publishers::look()
{
  if (topics_.empty()) {
    return;
  }
  const Topic & topic = topics_[next_];
  next_ = (next_ + 1) % topics_.size();
  report_(topic.name, faults(topic));
}

std::string Publishers::faults(const Topic & topic) const
{
  std::vector<std::string> found;
  for (const rclcpp::TopicEndpointInfo & info : node_.get_publishers_info_by_topic(topic.name)) {
    const std::string & space = info.node_namespace();
    const std::string name = (space == "/" ? "" : space) + '/' + info.node_name();
    std::string fault;
    if (info.topic_type() != topic.type) {
      fault = name + " publishes " + info.topic_type() + " on it, which is not heard";
    } else {
      const auto fit = rclcpp::qos_check_compatible(info.qos_profile(), topic.qos);
      if (fit.compatibility == rclcpp::QoSCompatibility::Error) {
        fault = name + " offers a QoS on it that is not heard: " + bare(fit.reason);
      }
    }
    if (!fault.empty() && std::find(found.begin(), found.end(), fault) == found.end()) {
      found.push_back(fault);
    }
  }
  return joined(found, "; ");
}

}  // namespace deros_runtime
