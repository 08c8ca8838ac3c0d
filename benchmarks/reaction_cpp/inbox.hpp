// Messages, taken by the thread that waits for them.

#ifndef INBOX_HPP_
#define INBOX_HPP_

#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "rclcpp/rclcpp.hpp"

/// The fastest way to a message: the middleware's thread wakes the one that waits, which takes it.
/// The executors of rclcpp were slower where this was measured, the EventsExecutor by 4 %, the
/// usual one by 17 %.
class Inbox
{
public:
  /// Hands the messages of a topic to a function: M, or rclcpp::SerializedMessage if that is what
  /// it takes.
  template<class M, class Function>
  void subscribe(
    rclcpp::Node & node, const std::string & topic, const rclcpp::QoS & qos, Function function)
  {
    constexpr bool typed = std::is_invocable_v<Function, const M &>;
    using Message = std::conditional_t<typed, M, rclcpp::SerializedMessage>;
    const auto subscription =
      node.create_subscription<M>(topic, qos, [](const M &) {});  // no executor calls it
    const std::size_t number = sources_.size();
    sources_.push_back(
      {subscription, [subscription, function, message = std::make_shared<Message>()]() {
          rclcpp::MessageInfo info;
          if constexpr (typed) {
            while (subscription->take(*message, info)) {
              function(*message);
            }
          } else {
            while (subscription->take_serialized(*message, info)) {
              function(*message);
            }
          }
        }});
    subscription->set_on_new_message_callback([this, number](std::size_t) {mark(number);});
  }

  /// Takes what is there; if nothing is, waits for something, until an instant at most.
  void wait(std::int64_t until)
  {
    const std::chrono::steady_clock::time_point end{std::chrono::nanoseconds(until)};
    {
      std::unique_lock<std::mutex> lock(mutex_);
      changed_.wait_until(lock, end, [this]() {return !ready_.empty() || stopped_;});
      std::swap(ready_, taken_);
    }
    for (const std::size_t number : taken_) {
      sources_[number].take();
    }
    taken_.clear();
  }

  /// Wakes who waits, now and from now on.
  void stop()
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    stopped_ = true;
    changed_.notify_all();
  }

  /// How many publishers a topic has, by the order of subscribing.
  std::size_t publishers(std::size_t number) const
  {
    return sources_[number].subscription->get_publisher_count();
  }

private:
  struct Source
  {
    std::shared_ptr<rclcpp::SubscriptionBase> subscription;
    std::function<void()> take;
  };

  void mark(std::size_t number)
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    ready_.push_back(number);
    changed_.notify_one();
  }

  std::vector<Source> sources_;
  std::mutex mutex_;
  std::condition_variable changed_;
  std::vector<std::size_t> ready_;
  std::vector<std::size_t> taken_;  // kept, so that its memory is
  bool stopped_ = false;
};

#endif  // INBOX_HPP_
