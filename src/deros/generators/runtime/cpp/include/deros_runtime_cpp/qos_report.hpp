// Copyright and licence: see package.xml.

/// \file
/// Logs endpoints of other nodes whose QoS is incompatible with that of a node.

#ifndef DEROS_RUNTIME_CPP__QOS_REPORT_HPP_
#define DEROS_RUNTIME_CPP__QOS_REPORT_HPP_

#include <string>

#include "rclcpp/rclcpp.hpp"

namespace deros_runtime_cpp
{

/// Logs an error when an endpoint with incompatible QoS appears.
/**
 * No message passes between incompatible endpoints. The middleware reports one policy; the graph
 * provides the name of the other node and all policies.
 */
class QosReport
{
public:
  /// Report for a node, managed or not.
  template<typename NodeT>
  explicit QosReport(NodeT & node)
  : base_(node.get_node_base_interface()),
    graph_(node.get_node_graph_interface()),
    topics_(node.get_node_topics_interface()),
    logger_(node.get_logger())
  {
  }

  /// Return the options of a publisher on a topic.
  rclcpp::PublisherOptions publisher(const std::string & topic) const;

  /// Return the options of a subscription of a topic.
  rclcpp::SubscriptionOptions subscription(const std::string & topic) const;

private:
  rclcpp::node_interfaces::NodeBaseInterface::SharedPtr base_;
  rclcpp::node_interfaces::NodeGraphInterface::SharedPtr graph_;
  rclcpp::node_interfaces::NodeTopicsInterface::SharedPtr topics_;
  rclcpp::Logger logger_;
};

}  // namespace deros_runtime_cpp

#endif  // DEROS_RUNTIME_CPP__QOS_REPORT_HPP_
