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

/// Serves subscriptions, services and clients in the thread of an event loop.
/**
 * The middleware notifies the event loop of messages, requests and responses. All messages of a
 * subscription are taken into the same object; with intra-process communication, they are shared by
 * pointer.
 */
class Ports
{
public:
  /// Takes a topic, and why a message on it cannot be deserialized.
  using ReportUndecodable = std::function<void (const std::string &, const std::string &)>;

  Ports(EventLoop & event_loop, ReportUndecodable report_undecodable);

  /// Stop notifying the event loop.
  ~Ports();
  Ports(const Ports &) = delete;
  Ports & operator=(const Ports &) = delete;

  /// Serve all ports of a callback group; no executor may spin it.
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
  void serve_responses(const rclcpp::ClientBase::SharedPtr & client);
  void serve_intra_process(const rclcpp::SubscriptionBase::SharedPtr & subscription);

  EventLoop & event_loop_;
  ReportUndecodable report_undecodable_;
  std::vector<rclcpp::SubscriptionBase::SharedPtr> subscriptions_;
  std::vector<rclcpp::Waitable::SharedPtr> intra_process_;
  std::vector<rclcpp::ServiceBase::SharedPtr> services_;
  std::vector<rclcpp::ClientBase::SharedPtr> clients_;
};

}  // namespace deros_runtime_cpp

#endif  // DEROS_RUNTIME_CPP__PORTS_HPP_
