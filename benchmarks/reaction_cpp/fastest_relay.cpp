// The fastest relay that rclcpp allows: a message in, after a while a constant one out.
//
// It has one lane per argument, SECONDS:IMU TOPIC:STATE TOPIC; 0 seconds are no while. At its end
// it prints four numbers in ns for each state that had to wait: the while, and by CLOCK_MONOTONIC
// when it was due, when the thread was there, and when the state had been published.

#include <algorithm>
#include <cinttypes>
#include <cstdint>
#include <cstdio>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "clock.hpp"
#include "inbox.hpp"
#include "qos.hpp"
#include "rclcpp/rclcpp.hpp"
#include "sensor_msgs/msg/imu.hpp"
#include "std_msgs/msg/bool.hpp"

namespace
{

constexpr std::int64_t NEVER = std::numeric_limits<std::int64_t>::max() / 2;

struct Fired
{
  std::int64_t duration, due, began, published;
};

/// One pair of topics.
class Lane
{
public:
  Lane(rclcpp::Node & node, Inbox & inbox, const std::string & text)
  {
    const std::size_t imu = text.find(':');
    const std::size_t state = text.find(':', imu + 1);
    duration_ = static_cast<std::int64_t>(std::stod(text.substr(0, imu)) * 1e9);
    state_.data = true;
    publisher_ = node.create_publisher<std_msgs::msg::Bool>(text.substr(state + 1), state_qos());
    inbox.subscribe<sensor_msgs::msg::Imu>(
      node, text.substr(imu + 1, state - imu - 1), imu_qos(),
      [this](const sensor_msgs::msg::Imu &) {
        if (duration_ == 0) {
          publisher_->publish(state_);
        } else {
          due = now() + duration_;
        }
      });
  }

  /// Publishes if it is time.
  void settle(std::vector<Fired> & fired)
  {
    const std::int64_t began = now();
    if (began >= due) {
      publisher_->publish(state_);
      fired.push_back({duration_, due, began, now()});
      due = NEVER;
    }
  }

  std::int64_t due = NEVER;

private:
  std::int64_t duration_;
  std_msgs::msg::Bool state_;
  rclcpp::Publisher<std_msgs::msg::Bool>::SharedPtr publisher_;
};

}  // namespace

int main(int argc, char ** argv)
{
  time_exactly();
  const std::vector<std::string> arguments = rclcpp::init_and_remove_ros_arguments(argc, argv);
  rclcpp::Node node("fastest_relay");
  Inbox inbox;
  rclcpp::on_shutdown([&inbox]() {inbox.stop();});
  std::vector<std::unique_ptr<Lane>> lanes;
  for (std::size_t i = 1; i < arguments.size(); i++) {
    lanes.push_back(std::make_unique<Lane>(node, inbox, arguments[i]));
  }
  std::vector<Fired> fired;
  fired.reserve(10000);
  while (rclcpp::ok()) {
    std::int64_t next = NEVER;
    for (const auto & lane : lanes) {
      next = std::min(next, lane->due);
    }
    inbox.wait(next);
    for (const auto & lane : lanes) {
      lane->settle(fired);
    }
  }
  std::printf("[");
  for (std::size_t i = 0; i < fired.size(); i++) {
    const Fired & each = fired[i];
    std::printf(
      "%s[%" PRId64 ",%" PRId64 ",%" PRId64 ",%" PRId64 "]", i == 0 ? "" : ",",
      each.duration, each.due, each.began, each.published);
  }
  std::printf("]");
  return 0;
}
