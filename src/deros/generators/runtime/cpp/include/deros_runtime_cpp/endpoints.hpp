// Copyright and licence: see package.xml.

/// \file
/// Publishers and subscriptions of other nodes, as the graph of the middleware lists them.

#ifndef DEROS_RUNTIME_CPP__ENDPOINTS_HPP_
#define DEROS_RUNTIME_CPP__ENDPOINTS_HPP_

#include <string>

#include "rclcpp/rclcpp.hpp"

namespace deros_runtime_cpp
{

/// Return the fully qualified name of the node of an endpoint; empty if it is not known yet.
/**
 * The middleware may discover a node later than its endpoints.
 */
std::string node_of(const rclcpp::TopicEndpointInfo & info);

/// Return the name of the node of an endpoint for a message: also if it is not known yet.
std::string shown_node_of(const rclcpp::TopicEndpointInfo & info);

/// Return why the middleware does not connect a publisher with a subscription; empty if it does.
std::string incompatibility(const rclcpp::QoS & offered, const rclcpp::QoS & requested);

}  // namespace deros_runtime_cpp

#endif  // DEROS_RUNTIME_CPP__ENDPOINTS_HPP_
