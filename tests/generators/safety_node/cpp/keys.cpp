// Shows what the rules are for elements that keys name: beside one another, in messages, in both.

#include <cstdint>
#include <cstdio>

#include "keys_safety_node_messages.hpp"

extern "C"
void keys_emit(void * /*owner*/, std::int64_t /*t*/, keys_kind /*kind*/, std::uint32_t /*site*/)
{
}

namespace
{

/// Print the verdict of each rule.
void show(const keys_monitor & m)
{
  std::printf(
    "%d %d %d %d %d\n", m.keys_joint, m.keys_level, m.keys_inner, m.keys_number, m.keys_text);
}

/// Take a message of each topic, and show what the rules are then.
void take_all(
  keys_monitor & m, std::int64_t now, const sensor_msgs::msg::JointState & joints,
  const diagnostic_msgs::msg::DiagnosticArray & health, const test_msgs::msg::Arrays & numbers,
  const test_msgs::msg::WStrings & wide)
{
  keys_safety_cpp::take_joints(m, now, joints);
  keys_safety_cpp::take_health(m, now, health);
  keys_safety_cpp::take_numbers(m, now, numbers);
  keys_safety_cpp::take_wide(m, now, wide);
  show(m);
}

}  // namespace

int main()
{
  keys_monitor m;
  keys_start(&m, nullptr, 0, 0);
  sensor_msgs::msg::JointState joints;
  diagnostic_msgs::msg::DiagnosticArray health;
  test_msgs::msg::Arrays numbers;
  test_msgs::msg::WStrings wide;
  take_all(m, 1, joints, health, numbers, wide);  // none has the element

  joints.name = {"wrist", "elbow \"a\" */", "elbow \"a\" */"};
  joints.position = {5.0, 0.5, 5.0};
  health.status.resize(3);
  health.status[0].name = "arm";
  health.status[0].values.resize(2);
  health.status[0].values[1].key = "class";
  health.status[0].values[1].value = "cold";
  health.status[1].name = "lidar";
  health.status[2].name = "lidar";
  health.status[2].level = 2;
  numbers.uint8_values = {1, 3, 3};
  numbers.int32_values = {9, 5, 9};
  wide.unbounded_sequence_of_wstrings = {u"a", u"\u00e4"};
  take_all(m, 2, joints, health, numbers, wide);  // the first that matches counts

  joints.position = {0.5, 5.0};
  health.status[0].values[1].value = "hot";
  health.status[1].level = 2;
  numbers.int32_values = {0, 9, 0};
  take_all(m, 3, joints, health, numbers, wide);

  joints.position = {0.5};  // too short
  health.status[0].values.clear();
  health.status[1].name = "camera";
  health.status[2].name = "radar";
  numbers.uint8_values = {1, 2, 4};
  wide.unbounded_sequence_of_wstrings = {u"a"};
  take_all(m, 4, joints, health, numbers, wide);
  return 0;
}
