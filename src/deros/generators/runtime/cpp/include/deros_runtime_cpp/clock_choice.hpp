// Copyright and licence: see package.xml.

#ifndef DEROS_RUNTIME_CPP__CLOCK_CHOICE_HPP_
#define DEROS_RUNTIME_CPP__CLOCK_CHOICE_HPP_

#include "rclcpp/rclcpp.hpp"

namespace deros_runtime_cpp
{

/// A handle; changes are rejected until its last copy is destroyed.
using ClockChoice = rclcpp::node_interfaces::OnSetParametersCallbackHandle::SharedPtr;

/// Reject changes of use_sim_time, with a reason.
/** Timers and deadlines of a running node belong to the clock that it was started with. */
ClockChoice refuse_clock_change(rclcpp::Node & node);

}  // namespace deros_runtime_cpp

#endif  // DEROS_RUNTIME_CPP__CLOCK_CHOICE_HPP_
