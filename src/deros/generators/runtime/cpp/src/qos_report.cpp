// Copyright and licence: see package.xml.

#include "deros_runtime_cpp/qos_report.hpp"

#include <set>
#include <string>
#include <utility>
#include <vector>

#include "deros_runtime_cpp/endpoints.hpp"

namespace deros_runtime_cpp
{

namespace
{

using rclcpp::TopicEndpointInfo;
using rclcpp::node_interfaces::NodeBaseInterface;
using rclcpp::node_interfaces::NodeGraphInterface;

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
        const std::string reason = incompatibility(offer.qos_profile(), request.qos_profile());
        if (!reason.empty()) {
          endpoints.insert(
            (is_publisher ? "does not reach " : "is not received from ") +
            shown_node_of(is_publisher ? request : offer) + ": " + reason);
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
