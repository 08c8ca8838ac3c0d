// Copyright and licence: see package.xml.

/// \file
/// The publishers and subscriptions of the target of a gate.

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

/// Checks the target of a gate for other publishers, and for subscriptions that do not match.
class TargetPublisherCheck
{
public:
  /// Takes a topic and its fault; an empty text if there is none.
  using Report = std::function<void (const std::string &, const std::string &)>;

  TargetPublisherCheck(
    EventLoop & event_loop, rclcpp::Node & node, const std::string & target, Report report);

  /// Check often from now on, as long as a second gate may have started at the same time.
  void start();

  /// Check now. \throw Refusal if there is a second gate and this one started last
  void check();

private:
  void check_early();
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
