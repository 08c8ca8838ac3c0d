// Copyright and licence: see package.xml.

/// \file
/// The part of the node of a gate that is common to all gates.

#ifndef DEROS_RUNTIME_CPP__GATE_RUNNER_HPP_
#define DEROS_RUNTIME_CPP__GATE_RUNNER_HPP_

#include <cstddef>
#include <cstdint>
#include <exception>
#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "deros_runtime_cpp/clock_choice.hpp"
#include "deros_runtime_cpp/descriptor.hpp"
#include "deros_runtime_cpp/event_loop.hpp"
#include "deros_runtime_cpp/gate_logic.hpp"
#include "deros_runtime_cpp/gate_report.hpp"
#include "deros_runtime_cpp/ports.hpp"
#include "deros_runtime_cpp/simulated_time.hpp"
#include "deros_runtime_cpp/worker.hpp"
#include "rclcpp/rclcpp.hpp"
#include "rclcpp/serialization.hpp"

namespace deros_runtime_cpp
{

/// The part of the node of a gate that the runner calls.
class GateNode
{
public:
  virtual ~GateNode() = default;

  /// Publish a report.
  virtual void report(const GateReport::Message & message) = 0;

  /// Check the publishers of the topics that the gate obeys; called once a second.
  virtual void check_publishers() = 0;
};

/// Deserialize a message; return false if that fails.
template<typename MessageT>
bool read(const rclcpp::SerializedMessage & data, MessageT & message)
{
  static const rclcpp::Serialization<MessageT> serialization;
  try {
    serialization.deserialize_message(&data, &message);
  } catch (const std::exception &) {  // which exception depends on the type of the message
    return false;
  }
  return true;
}

/// Drives a gate from a clock, and passes messages to it, all in one thread.
/**
 * The clock is the steady clock, which never steps, whatever the time of the robot is. For tests,
 * it can be that of /clock if the node uses it.
 */
class GateRunner
{
public:
  /// Takes a serialized message.
  using Take =
    std::function<void (const rclcpp::SerializedMessage &, const rclcpp::MessageInfo &)>;

  /// Parameters of the node.
  struct Settings
  {
    std::int64_t realtime_priority;
    bool lock_memory;
    bool losses_in_simulated_time;
  };

  /// Configure the process and take the single-instance lock.
  /** \throw Refusal if a node of the same name runs already */
  GateRunner(
    rclcpp::Node & node, Gate & gate, GateNode & owner, const std::string & target,
    Settings settings);
  ~GateRunner();
  GateRunner(const GateRunner &) = delete;
  GateRunner & operator=(const GateRunner &) = delete;

  /// Subscribe to a topic, whose messages stay serialized; to be called before start().
  template<typename MessageT>
  SubscribedTopic subscribe(
    const std::string & topic, const rclcpp::QoS & qos, Take take)
  {
    rclcpp::SubscriptionOptions options;
    options.callback_group = group_;
    options.use_intra_process_comm = rclcpp::IntraProcessSetting::Disable;
    const auto subscription = node_.create_subscription<MessageT>(topic, qos, take, options);
    const std::string type = rosidl_generator_traits::name<MessageT>();
    serve(subscription, type);
    return {subscription->get_topic_name(), type, subscription->get_actual_qos()};
  }

  /// Serve a service that resets the gate; to be called before start().
  template<typename ServiceT>
  void serve_reset(const std::string & name)
  {
    ports_.serve(
      node_.create_service<ServiceT>(
        name,
        [this](
          const typename ServiceT::Request::SharedPtr,
          typename ServiceT::Response::SharedPtr response) {
          response->success = gate_.on_reset(now());
          settle();
          response->message = report_.answer(response->success);
        },
        rclcpp::ServicesQoS(), group_));
  }

  /// Start the gate: publish the zeros that are due, then process messages.
  void start();

  // Called in the thread of the node

  /// Return the time of the gate.
  Time now() const
  {
    return clock_.now();
  }

  /// Schedule the next deadline of the gate; to be called after each message.
  void settle();

  /// Count a rejected command.
  void refuse(const std::string & cause)
  {
    report_.refuse(cause);
  }

  /// Set the fault of a subject or, with an empty text, clear it.
  void fault(const std::string & subject, const std::string & text)
  {
    report_.fault(subject, text);
  }

  // Called in other threads

  /// Stop the thread, and wait for it; see Worker.
  void stop();
  void when_ended(std::function<void()> ended);
  std::exception_ptr failure() const;

private:
  void serve(const rclcpp::SubscriptionBase::SharedPtr & subscription, const std::string & type);
  void advance();
  void check_publishers();

  rclcpp::Node & node_;
  Gate & gate_;
  GateNode & owner_;
  std::vector<std::string> not_permitted_;  // by the operating system
  Descriptor lock_;
  const ClockChoice clock_choice_;
  rclcpp::CallbackGroup::SharedPtr group_;  // which no executor spins
  EventLoop event_loop_;
  std::unique_ptr<SimulatedTime> simulated_;
  const Clock clock_;
  GateReport report_;
  OneShotTimer deadline_;
  OneShotTimer check_;
  std::vector<rclcpp::SubscriptionBase::SharedPtr> subscriptions_;
  Ports ports_;
  Worker worker_;
};

}  // namespace deros_runtime_cpp

#endif  // DEROS_RUNTIME_CPP__GATE_RUNNER_HPP_
