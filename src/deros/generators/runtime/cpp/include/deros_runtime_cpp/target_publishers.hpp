// Copyright and licence: see package.xml.

/// \file
/// The target of a gate: who else publishes on it, and whom the gate's commands do not reach.

#ifndef DEROS_RUNTIME_CPP__TARGET_PUBLISHERS_HPP_
#define DEROS_RUNTIME_CPP__TARGET_PUBLISHERS_HPP_

#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "deros_runtime_cpp/event_loop.hpp"
#include "deros_runtime_cpp/start_order.hpp"
#include "rclcpp/rclcpp.hpp"

namespace deros_runtime_cpp
{

/// Looks for publishers on the target of a gate beside its own, and for unserved readers.
class TargetPublishers
{
public:
  /// Takes the topic and what is wrong with it, empty if nothing is.
  using Report = std::function<void (const std::string &, const std::string &)>;

  TargetPublishers(
    EventLoop & event_loop, rclcpp::Node & node, const std::string & target, Report report);

  /// Look often from now on, while a second gate might be met.
  void begin();

  /// Look now. \throw Refusal if there is a second gate and this one started last
  void look();

private:
  void look_early();
  std::pair<std::vector<std::string>, std::string> find();

  rclcpp::Node & node_;
  const std::string target_;
  Report report_;
  StartOrder order_;
  const Time early_until_;
  OneShotTimer early_;
};

}  // namespace deros_runtime_cpp

#endif  // DEROS_RUNTIME_CPP__TARGET_PUBLISHERS_HPP_
