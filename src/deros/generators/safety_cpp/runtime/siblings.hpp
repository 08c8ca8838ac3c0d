#ifndef DEROS_RUNTIME__RUNTIME__SIBLINGS_HPP_
#define DEROS_RUNTIME__RUNTIME__SIBLINGS_HPP_

#include <functional>
#include <string>

#include "deros_runtime/runtime/agenda.hpp"
#include "rclcpp/rclcpp.hpp"

namespace deros_runtime
{

/// Looks whether somebody else publishes the heartbeat of a node: one on another machine.
class Siblings
{
public:
  /// Takes the topic and what is wrong with it, empty if nothing is.
  using Report = std::function<void (const std::string &, const std::string &)>;

  Siblings(rclcpp::Node & node, std::string heartbeat, Report report);

  /// Look now. \throw Refusal if there is one and this node has just started
  void look();

private:
  rclcpp::Node & node_;
  std::string heartbeat_;
  Report report_;
  Time give_way_until_;
};

}  // namespace deros_runtime

#endif  // DEROS_RUNTIME__RUNTIME__SIBLINGS_HPP_
