// Copyright and licence: see package.xml.

#ifndef DEROS_RUNTIME_CPP__SIMULATED_TIME_HPP_
#define DEROS_RUNTIME_CPP__SIMULATED_TIME_HPP_

#include <functional>
#include <memory>

#include "deros_runtime_cpp/event_loop.hpp"
#include "rclcpp/rclcpp.hpp"
#include "rosgraph_msgs/msg/clock.hpp"

namespace deros_runtime_cpp
{

/// When simulated time begins, in nanoseconds: with room for 73 years back and forth.
constexpr Time BEGINNING = Time(1) << 61;

/// Simulated time as the thread of an event loop sees it: in order with messages and requests.
/**
 * It counts from BEGINNING, and stands still until the first /clock comes. ROS time leaps then,
 * this one does not: whatever has been received before is as new as it was.
 *
 * rclcpp reads /clock in a separate thread, whose time runs ahead of messages that wait to be
 * taken: an input would be reported missing although its message has been received.
 */
class SimulatedTime
{
public:
  /**
   * \param changed is called in the thread of the event loop when time begins, and whenever it
   *   changes; its argument is whether it has begun or gone back
   */
  SimulatedTime(rclcpp::Node & node, EventLoop & event_loop, std::function<void(bool)> changed);

  /// Stop notifying the event loop.
  ~SimulatedTime();
  SimulatedTime(const SimulatedTime &) = delete;
  SimulatedTime & operator=(const SimulatedTime &) = delete;

  /// Return the clock of simulated time.
  Clock clock() const
  {
    return {[this] {return now_;}, false, [this] {return origin_;}};
  }

  /// Return whether time has begun; before that, nothing can become due.
  bool has_begun() const
  {
    return origin_ != -BEGINNING;
  }

  /// Return the subscription to /clock.
  const rclcpp::SubscriptionBase & subscription() const
  {
    return *subscription_;
  }

private:
  using Message = rosgraph_msgs::msg::Clock;

  void take();

  std::function<void(bool)> changed_;
  Time now_ = BEGINNING;
  Time origin_ = -BEGINNING;
  Message message_;
  rclcpp::CallbackGroup::SharedPtr group_;  // which no executor spins
  rclcpp::Subscription<Message>::SharedPtr subscription_;
};

/// Return the simulated time of a node with use_sim_time; none for other nodes.
std::unique_ptr<SimulatedTime> simulated_time(
  rclcpp::Node & node, EventLoop & event_loop, std::function<void(bool)> changed);

/// Return the time at which a node starts.
/** \param may_be_simulated whether use_sim_time applies */
Time start_time(const rclcpp::Node & node, bool may_be_simulated);

/// Return the clock of simulated time, or the steady one if there is none.
Clock clock_of(const std::unique_ptr<SimulatedTime> & simulated);

}  // namespace deros_runtime_cpp

#endif  // DEROS_RUNTIME_CPP__SIMULATED_TIME_HPP_
