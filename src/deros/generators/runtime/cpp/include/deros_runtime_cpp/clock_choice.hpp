// Copyright and licence: see package.xml.

#ifndef DEROS_RUNTIME_CPP__CLOCK_CHOICE_HPP_
#define DEROS_RUNTIME_CPP__CLOCK_CHOICE_HPP_

#include "rclcpp/rclcpp.hpp"

namespace deros_runtime_cpp
{

/// What keeps a refusal in force; it ends with the last copy of it.
using ClockChoice = rclcpp::node_interfaces::OnSetParametersCallbackHandle::SharedPtr;

/// Refuse, with a reason, to change use_sim_time as long as the result is kept.
/**
 * Timers and deadlines of a running node belong to the clock that it started with.
 */
ClockChoice refuse_clock_change(rclcpp::Node & node);

}  // namespace deros_runtime_cpp

#endif  // DEROS_RUNTIME_CPP__CLOCK_CHOICE_HPP_
