// Copyright and licence: see package.xml.

#include "deros_runtime_cpp/endpoints.hpp"

#include <cstddef>
#include <sstream>
#include <string>

namespace deros_runtime_cpp
{

std::string node_of(const rclcpp::TopicEndpointInfo & info)
{
  // The name that the middleware gives to a node whose name it does not know yet.
  if (info.node_name().empty() || info.node_name() == "_NODE_NAME_UNKNOWN_") {
    return "";
  }
  const std::string & space = info.node_namespace();
  return (space == "/" ? "" : space) + '/' + info.node_name();
}

std::string shown_node_of(const rclcpp::TopicEndpointInfo & info)
{
  const std::string name = node_of(info);
  return name.empty() ? "a node that is not known yet" : name;
}

std::string incompatibility(const rclcpp::QoS & offered, const rclcpp::QoS & requested)
{
  const auto fit = rclcpp::qos_check_compatible(offered, requested);
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

}  // namespace deros_runtime_cpp
