#include "deros_runtime/runtime/siblings.hpp"

#include <string>
#include <utility>

#include "deros_runtime/runtime/refusal.hpp"

namespace deros_runtime
{

namespace
{

// Who finds another one within this time, in ns, of its start gives way.
constexpr Time EARLY = 5'000'000'000;

}  // namespace

Siblings::Siblings(rclcpp::Node & node, std::string heartbeat, Report report)
: node_(node),
  heartbeat_(std::move(heartbeat)),
  report_(std::move(report)),
  give_way_until_(steady_now() + EARLY)
{
}

void Siblings::look()
{
  if (node_.count_publishers(heartbeat_) <= 1) {
    report_(heartbeat_, "");
    return;
  }
  const std::string text =
    "another node publishes this heartbeat: whoever heeds it cannot tell them apart";
  if (steady_now() < give_way_until_) {
    throw Refusal(heartbeat_ + ": " + text + "; this one started last and ends now");
  }
  report_(heartbeat_, text);
}

}  // namespace deros_runtime
