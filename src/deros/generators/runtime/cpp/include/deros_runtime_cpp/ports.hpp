// Copyright and licence: see package.xml.

#ifndef DEROS_RUNTIME_CPP__PORTS_HPP_
#define DEROS_RUNTIME_CPP__PORTS_HPP_

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "deros_runtime_cpp/event_loop.hpp"
#include "rclcpp/rclcpp.hpp"

namespace deros_runtime_cpp
{

/// The subscriptions and services of a callback group, served by the thread of an event loop.
/**
 * The middleware notes what comes with the event loop; there each message is taken into the same
 * object again and again. Within a process that shares messages by pointer, they come as they are.
 */
class Ports
{
public:
  /// Takes a topic, and why a message of it cannot be read.
  using Refuse = std::function<void (const std::string &, const std::string &)>;

  Ports(EventLoop & event_loop, Refuse refuse);

  /// From here on nothing is noted any more.
  ~Ports();
  Ports(const Ports &) = delete;
  Ports & operator=(const Ports &) = delete;

  /// Serve all that a callback group has now; no executor may spin it.
  void serve(const rclcpp::CallbackGroup & group);

  /// Serve a service; no executor may spin its callback group.
  void serve(const rclcpp::ServiceBase::SharedPtr & service);

  /// Return the subscriptions.
  const std::vector<rclcpp::SubscriptionBase::SharedPtr> & subscriptions() const
  {
    return subscriptions_;
  }

private:
  void serve_messages(const rclcpp::SubscriptionBase::SharedPtr & subscription);
  void serve_shared(const rclcpp::SubscriptionBase::SharedPtr & subscription);

  EventLoop & event_loop_;
  Refuse refuse_;
  std::vector<rclcpp::SubscriptionBase::SharedPtr> subscriptions_;
  std::vector<rclcpp::Waitable::SharedPtr> shared_;
  std::vector<rclcpp::ServiceBase::SharedPtr> services_;
};

}  // namespace deros_runtime_cpp

#endif  // DEROS_RUNTIME_CPP__PORTS_HPP_
