// Copyright and licence: see package.xml.

#include "deros_runtime_cpp/clock_choice.hpp"

#include <vector>

namespace deros_runtime_cpp
{

namespace
{

constexpr const char * USE_SIM_TIME = "use_sim_time";

}  // namespace

ClockChoice refuse_clock_change(rclcpp::Node & node)
{
  const rclcpp::ParameterValue chosen = node.get_parameter(USE_SIM_TIME).get_parameter_value();
  return node.add_on_set_parameters_callback(
    [chosen](const std::vector<rclcpp::Parameter> & parameters) {
      rcl_interfaces::msg::SetParametersResult result;
      result.successful = true;
      for (const rclcpp::Parameter & each : parameters) {
        if (each.get_name() == USE_SIM_TIME && each.get_parameter_value() != chosen) {
          result.successful = false;
          result.reason = "use_sim_time cannot change while the node runs: start it anew";
        }
      }
      return result;
    });
}

}  // namespace deros_runtime_cpp
