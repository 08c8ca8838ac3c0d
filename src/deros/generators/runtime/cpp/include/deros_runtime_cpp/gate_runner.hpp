// Copyright and licence: see package.xml.

/// \file
/// The part of a gate's node that is the same for all gates.

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
#include "deros_runtime_cpp/gate_report.hpp"
#include "deros_runtime_cpp/ports.hpp"
#include "deros_runtime_cpp/simulated_time.hpp"
#include "deros_runtime_cpp/worker.hpp"
#include "rclcpp/rclcpp.hpp"
#include "rclcpp/serialization.hpp"

namespace deros_runtime_cpp
{

/// The logic of a gate, and where it tells of itself.
class GateLogic : public GateStatus
{
public:
  /// Do what is due up to and including now.
  virtual void advance(Time now) = 0;

  /// Return when to call advance() at the latest.
  virtual Time next_deadline() const = 0;

  virtual void report(const GateReport::Message & message) = 0;

  /// Look who publishes what the gate obeys; it is asked to once a second.
  virtual void check_publishers() = 0;
};

/// Read a message; return false if it is none of this type.
template<typename MessageT>
bool read(const rclcpp::SerializedMessage & data, MessageT & message)
{
  static const rclcpp::Serialization<MessageT> serialization;
  try {
    serialization.deserialize_message(&data, &message);
  } catch (const std::exception &) {  // each type of message may find another kind of fault in it
    return false;
  }
  return true;
}

/// A gate in time: it is told what comes and what time it is, all in one thread of its own.
/**
 * It runs on steady time, which never steps, whatever the robot's time is; for tests, it can run
 * on /clock, if the node does.
 */
class GateRunner
{
public:
  /// Takes a message as it came.
  using Take =
    std::function<void (const rclcpp::SerializedMessage &, const rclcpp::MessageInfo &)>;

  /// Parameters of the node.
  struct Settings
  {
    std::int64_t realtime_priority;
    bool lock_memory;
    bool losses_in_simulated_time;
  };

  /// Refuse to be a second one of the node's name, and prepare the process.
  /** \throw Refusal if there is one */
  GateRunner(
    rclcpp::Node & node, GateLogic & gate, std::vector<std::string> lines,
    const std::string & target, Settings settings);
  ~GateRunner();
  GateRunner(const GateRunner &) = delete;
  GateRunner & operator=(const GateRunner &) = delete;

  /// Hear a topic, whose messages are handed over as they came; to be called before start().
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
  /**
   * \param reset returns the lines of the gate that refuse it; none: it is done
   */
  template<typename ServiceT>
  void serve_reset(const std::string & name, std::function<std::vector<std::string>()> reset)
  {
    ports_.serve(
      node_.create_service<ServiceT>(
        name,
        [this, reset](
          const typename ServiceT::Request::SharedPtr,
          typename ServiceT::Response::SharedPtr response) {
          const std::vector<std::string> against = reset();
          settle();
          response->success = against.empty();
          response->message = report_.answer(against);
        },
        rclcpp::ServicesQoS(), group_));
  }

  /// Start the gate: with the zeros that are due, and then with what comes.
  void start();

  // What the thread of the node does

  /// Return the time that the gate is told.
  Time now() const
  {
    return clock_.now();
  }

  /// Wake up for the gate's next deadline; to be called after each message.
  void settle();

  /// Count a command that was refused.
  void refuse(const std::string & cause)
  {
    report_.refuse(cause);
  }

  /// Note or, with an empty text, forget what is wrong with something.
  void fault(const std::string & subject, const std::string & text)
  {
    report_.fault(subject, text);
  }

  // What others do

  /// End the thread; see Worker.
  void stop();
  void when_ended(std::function<void()> ended);
  std::exception_ptr failure() const;

private:
  void serve(const rclcpp::SubscriptionBase::SharedPtr & subscription, const std::string & type);
  void advance();
  void check_publishers();

  rclcpp::Node & node_;
  GateLogic & gate_;
  std::vector<std::string> refused_;  // by the machine
  Descriptor lock_;
  const ClockChoice clock_choice_;
  rclcpp::CallbackGroup::SharedPtr group_;  // that no executor spins
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
