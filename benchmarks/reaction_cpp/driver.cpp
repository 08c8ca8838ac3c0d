// The end of all topics that the benchmark holds: it publishes, receives and takes the time.
//
// Another program decides what is to be done, and when; this one does it, so that nothing of the
// other is in the figures. Arguments: lane:IMU TOPIC:STATE TOPIC and record:TOPIC. It reads
// commands from stdin, a line each, and answers each by a line on stdout, until stdin ends:
//
//   meet MILLISECONDS            receives for a while; says which topics have nobody at their end
//   until INSTANT                receives until then
//   send LANE ROLL EXPECTED      sends a tilt of ROLL rad; the answer is a state with EXPECTED, 0 or 1
//   ask LANE ROLL EXPECTED LIMIT the same, and receives until the answer is there, for LIMIT ns at most
//   records                      the events received so far, as hexadecimal bytes: TOPIC:BYTES ...
//
// All answers but the first and the last are numbers: when it sent, or 0, then pairs of lane and
// instant for each state that has come since the answer before. Instants are of CLOCK_MONOTONIC, in
// ns, taken just before the message is published and just after the state is received.

#include <cmath>
#include <cstdint>
#include <iostream>
#include <limits>
#include <memory>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "clock.hpp"
#include "diagnostic_msgs/msg/diagnostic_status.hpp"
#include "inbox.hpp"
#include "qos.hpp"
#include "rclcpp/rclcpp.hpp"
#include "sensor_msgs/msg/imu.hpp"
#include "std_msgs/msg/bool.hpp"

namespace
{

/// Until who gave the command sleeps again.
constexpr std::int64_t SETTLE_NS = 300'000;

struct Lane
{
  std::string imu, state;
  rclcpp::Publisher<sensor_msgs::msg::Imu>::SharedPtr publisher;
  std::size_t subscription;
  int expected = -1;
};

class Driver
{
public:
  explicit Driver(const std::vector<std::string> & arguments)
  : node_("benchmark")
  {
    lanes_.reserve(arguments.size());
    for (const std::string & each : arguments) {
      const std::size_t first = each.find(':');
      const std::size_t second = each.find(':', first + 1);
      if (each.substr(0, first) == "lane") {
        open_lane(each.substr(first + 1, second - first - 1), each.substr(second + 1));
      } else {
        open_record(each.substr(first + 1));
      }
    }
    rclcpp::on_shutdown([this]() {inbox_.stop();});
  }

  std::string answer(const std::string & line)
  {
    std::istringstream words(line);
    std::string command;
    std::size_t lane = 0;
    double roll = 0.0;
    int expected = 0;
    std::int64_t number = 0;
    words >> command;
    if (command == "meet") {
      words >> number;
      receive_until(now() + number * 1'000'000);
      return missing();
    }
    if (command == "records") {
      return recorded();
    }
    if (command == "until") {
      words >> number;
      receive_until(number);
      return received(0);
    }
    words >> lane >> roll >> expected;
    receive_until(now() + SETTLE_NS);
    const std::int64_t sent = send(lanes_.at(lane), roll, expected);
    if (command == "ask") {
      words >> number;
      await(lanes_[lane], sent + number);
    }
    return received(sent);
  }

private:
  void open_lane(const std::string & imu, const std::string & state)
  {
    const std::size_t number = lanes_.size();
    lanes_.push_back(
      {imu, state, node_.create_publisher<sensor_msgs::msg::Imu>(imu, imu_qos()), subscribed_++});
    inbox_.subscribe<std_msgs::msg::Bool>(
      node_, state, rclcpp::QoS(10).reliable(), [this, number](const std_msgs::msg::Bool & message) {
        const std::int64_t instant = now();
        Lane & lane = lanes_[number];
        if (static_cast<int>(message.data) == lane.expected) {
          lane.expected = -1;
          answers_.emplace_back(number, instant);
        }
      });
  }

  void open_record(const std::string & topic)
  {
    record_topics_.emplace_back(topic, subscribed_++);
    inbox_.subscribe<diagnostic_msgs::msg::DiagnosticStatus>(
      node_, topic, record_qos(), [this, topic](const rclcpp::SerializedMessage & message) {
        const auto & bytes = message.get_rcl_serialized_message();
        records_.emplace_back(
          topic, std::vector<std::uint8_t>(bytes.buffer, bytes.buffer + bytes.buffer_length));
      });
  }

  void receive_until(std::int64_t instant)
  {
    while (rclcpp::ok() && now() < instant) {
      inbox_.wait(instant);
    }
  }

  std::int64_t send(Lane & lane, double roll, int expected)
  {
    message_.header.frame_id = "imu_link";
    message_.orientation.x = std::sin(roll / 2.0);
    message_.orientation.w = std::cos(roll / 2.0);
    lane.expected = expected;
    const std::int64_t sent = now();
    lane.publisher->publish(message_);
    return sent;
  }

  void await(Lane & lane, std::int64_t limit)
  {
    while (rclcpp::ok() && lane.expected >= 0 && now() < limit) {
      inbox_.wait(limit);
    }
    lane.expected = -1;
  }

  std::string received(std::int64_t sent)
  {
    std::ostringstream text;
    text << sent;
    for (const auto & [lane, instant] : answers_) {
      text << ' ' << lane << ' ' << instant;
    }
    answers_.clear();
    return text.str();
  }

  std::string missing() const
  {
    std::ostringstream text;
    for (const Lane & lane : lanes_) {
      if (lane.publisher->get_subscription_count() == 0) {
        text << lane.imu << ' ';
      }
      if (inbox_.publishers(lane.subscription) == 0) {
        text << lane.state << ' ';
      }
    }
    for (const auto & [topic, subscription] : record_topics_) {
      if (inbox_.publishers(subscription) == 0) {
        text << topic << ' ';
      }
    }
    return text.str();
  }

  std::string recorded() const
  {
    static const char digits[] = "0123456789abcdef";
    std::string text;
    for (const auto & [topic, bytes] : records_) {
      text += topic + ':';
      for (const std::uint8_t byte : bytes) {
        text += digits[byte >> 4];
        text += digits[byte & 15];
      }
      text += ' ';
    }
    return text;
  }

  rclcpp::Node node_;
  Inbox inbox_;
  sensor_msgs::msg::Imu message_;
  std::vector<Lane> lanes_;
  std::size_t subscribed_ = 0;
  std::vector<std::pair<std::size_t, std::int64_t>> answers_;
  std::vector<std::pair<std::string, std::size_t>> record_topics_;
  std::vector<std::pair<std::string, std::vector<std::uint8_t>>> records_;
};

}  // namespace

int main(int argc, char ** argv)
{
  time_exactly();
  std::vector<std::string> arguments = rclcpp::init_and_remove_ros_arguments(argc, argv);
  arguments.erase(arguments.begin());
  {
    Driver driver(arguments);
    std::string line;
    while (rclcpp::ok() && std::getline(std::cin, line)) {
      std::cout << driver.answer(line) << std::endl;
    }
  }
  rclcpp::shutdown();
  return 0;
}
