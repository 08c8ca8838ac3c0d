// A relay as rclcpp's tutorials write it: typed messages, rclcpp::spin, nothing else.

#include <memory>

#include "qos.hpp"
#include "rclcpp/rclcpp.hpp"
#include "sensor_msgs/msg/imu.hpp"
#include "std_msgs/msg/bool.hpp"

class UsualRelay : public rclcpp::Node
{
public:
  UsualRelay()
  : Node("usual_relay"),
    publisher_(create_publisher<std_msgs::msg::Bool>("state", state_qos())),
    subscription_(create_subscription<sensor_msgs::msg::Imu>(
        "imu", imu_qos(), [this](const sensor_msgs::msg::Imu &) {publish();}))
  {
  }

private:
  void publish()
  {
    std_msgs::msg::Bool state;
    state.data = true;
    publisher_->publish(state);
  }

  rclcpp::Publisher<std_msgs::msg::Bool>::SharedPtr publisher_;
  rclcpp::Subscription<sensor_msgs::msg::Imu>::SharedPtr subscription_;
};

int main(int argc, char ** argv)
{
  rclcpp::init(argc, argv);
  rclcpp::spin(std::make_shared<UsualRelay>());
  rclcpp::shutdown();
  return 0;
}
