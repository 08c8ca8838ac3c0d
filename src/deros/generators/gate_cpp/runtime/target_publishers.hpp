/// \file
/// Who else publishes on the target of a gate: a second gate of its name, or a node past it.

#ifndef DEROS_RUNTIME__RUNTIME__TARGET_PUBLISHERS_HPP_
#define DEROS_RUNTIME__RUNTIME__TARGET_PUBLISHERS_HPP_

#include <functional>
#include <string>

#include "deros_runtime/runtime/agenda.hpp"
#include "rclcpp/rclcpp.hpp"

namespace deros_runtime
{

/// Looks for publishers on the target of a gate beside its own.
class TargetPublishers
{
public:
  /// Takes the topic and what is wrong with it, empty if nothing is.
  using Report = std::function<void (const std::string &, const std::string &)>;

  TargetPublishers(rclcpp::Node & node, const std::string & target, Report report);

  /// Look now. \throw Refusal if there is a second gate and this one has just started
  void look();

private:
  rclcpp::Node & node_;
  const std::string target_;
  Report report_;
  const Time give_way_until_;
  int found_ = 0;  // looks in a row that have found a second gate
};

}  // namespace deros_runtime

#endif  // DEROS_RUNTIME__RUNTIME__TARGET_PUBLISHERS_HPP_
