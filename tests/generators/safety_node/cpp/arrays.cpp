// Shows what the rules are for arrays of each kind: of any length, bounded, and fixed.

#include <cstdint>
#include <cstdio>

#include "arrays_safety_node_messages.hpp"

extern "C"
void arrays_emit(void * /*owner*/, std::int64_t /*t*/, arrays_kind /*kind*/, std::uint32_t /*site*/)
{
}

namespace
{

/// Print the verdict of each rule.
void show(const arrays_monitor & m)
{
  std::printf("%d %d %d\n", m.array_vector, m.array_bounded, m.array_fixed);
}

/// Take a message of each kind that a function has filled in, and show what the rules are then.
template<typename Take>
void take_all(arrays_monitor & m, std::int64_t now, const Take & fill)
{
  test_msgs::msg::UnboundedSequences vector;
  test_msgs::msg::BoundedSequences bounded;
  test_msgs::msg::Arrays fixed;
  fill(vector);
  fill(bounded);
  fill(fixed);
  arrays_safety_cpp::take_any_length(m, now, vector);
  arrays_safety_cpp::take_at_most_three(m, now, bounded);
  arrays_safety_cpp::take_three(m, now, fixed);
  show(m);
}

}  // namespace

int main()
{
  arrays_monitor m;
  arrays_start(&m, nullptr, 0, 0);
  take_all(m, 1, [](auto &) {});
  take_all(
    m, 2, [](auto & msg) {
      msg.bool_values = {true, false, true};
      msg.int32_values = {7, 8, 7};
    });
  take_all(
    m, 3, [](auto & msg) {
      msg.bool_values = {false, false, true};
      msg.int32_values = {9, 0, 8};
    });
  return 0;
}
