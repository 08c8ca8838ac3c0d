// Copyright and licence: see package.xml.

#include "deros_runtime_cpp/qos_report.hpp"

#include <cstddef>
#include <set>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

namespace deros_runtime_cpp
{

namespace
{

using rclcpp::TopicEndpointInfo;
using rclcpp::node_interfaces::NodeBaseInterface;
using rclcpp::node_interfaces::NodeGraphInterface;

/// Return why the QoS of a publisher and a subscription are incompatible; empty if they are not.
std::string incompatible(const TopicEndpointInfo & offer, const TopicEndpointInfo & request)
{
  const auto fit = rclcpp::qos_check_compatible(offer.qos_profile(), request.qos_profile());
  if (fit.compatibility != rclcpp::QoSCompatibility::Error) {
    return "";
  }
  const std::string mark = "ERROR: ";
  std::string reasons;
  std::istringstream parts(fit.reason);
  for (std::string part; std::getline(parts, part, ';'); ) {
    if (const std::size_t at = part.find(mark); at != std::string::npos) {
      reasons += (reasons.empty() ? "" : "; ") + part.substr(at + mark.size());
    }
  }
  return reasons;
}

/// Return the name of a node; the middleware may know its topics earlier.
std::string node_of(const TopicEndpointInfo & info)
{
  if (info.node_name().empty() || info.node_name() == "_NODE_NAME_UNKNOWN_") {
    return "a node that is not known yet";
  }
  const std::string & space = info.node_namespace();
  return (space == "/" ? "" : space) + '/' + info.node_name();
}

/// The report of one endpoint of a node.
class EndpointReport
{
public:
  EndpointReport(
    NodeBaseInterface::SharedPtr base, NodeGraphInterface::SharedPtr graph, rclcpp::Logger logger,
    std::string topic)
  : base_(std::move(base)),
    graph_(std::move(graph)),
    logger_(std::move(logger)),
    topic_(std::move(topic))
  {
  }

  /// Log the endpoints that are incompatible with the publisher or subscription of the node.
  void report(bool is_publisher, rmw_qos_policy_kind_t policy)
  {
    const std::set<std::string> endpoints = incompatible_endpoints(is_publisher);
    bool is_reported = false;
    for (const std::string & endpoint : endpoints) {
      if (known_.count(endpoint) == 0) {
        RCLCPP_ERROR(logger_, "%s %s", topic_.c_str(), endpoint.c_str());
        is_reported = true;
      }
    }
    if (!is_reported) {
      RCLCPP_ERROR(
        logger_, "%s: an end of another node does not match in the QoS policy %s", topic_.c_str(),
        rclcpp::qos_policy_name_from_kind(policy).c_str());
    }
    known_ = endpoints;
  }

private:
  std::set<std::string> incompatible_endpoints(bool is_publisher) const
  {
    const std::string own = base_->get_fully_qualified_name();
    const std::vector<TopicEndpointInfo> offers = graph_->get_publishers_info_by_topic(topic_);
    const std::vector<TopicEndpointInfo> requests = graph_->get_subscriptions_info_by_topic(topic_);
    std::set<std::string> endpoints;
    for (const TopicEndpointInfo & offer : offers) {
      for (const TopicEndpointInfo & request : requests) {
        if (node_of(is_publisher ? offer : request) != own) {
          continue;
        }
        const std::string reason = incompatible(offer, request);
        if (!reason.empty()) {
          endpoints.insert(
            (is_publisher ? "does not reach " : "is not heard from ") +
            node_of(is_publisher ? request : offer) + ": " + reason);
        }
      }
    }
    return endpoints;
  }

  NodeBaseInterface::SharedPtr base_;
  NodeGraphInterface::SharedPtr graph_;
  rclcpp::Logger logger_;
  std::string topic_;
  std::set<std::string> known_;
};

}  // namespace

rclcpp::PublisherOptions QosReport::publisher(const std::string & topic) const
{
  rclcpp::PublisherOptions options;
  options.event_callbacks.incompatible_qos_callback =
    [report = EndpointReport(base_, graph_, logger_, topics_->resolve_topic_name(topic))](
    rclcpp::QOSOfferedIncompatibleQoSInfo & event) mutable {
      report.report(true, event.last_policy_kind);
    };
  return options;
}

rclcpp::SubscriptionOptions QosReport::subscription(const std::string & topic) const
{
  rclcpp::SubscriptionOptions options;
  options.event_callbacks.incompatible_qos_callback =
    [report = EndpointReport(base_, graph_, logger_, topics_->resolve_topic_name(topic))](
    rclcpp::QOSRequestedIncompatibleQoSInfo & event) mutable {
      report.report(false, event.last_policy_kind);
    };
  return options;
}

}  // namespace deros_runtime_cpp
