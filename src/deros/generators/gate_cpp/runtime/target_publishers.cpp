#include "deros_runtime/runtime/target_publishers.hpp"

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "deros_runtime/runtime/publishers.hpp"
#include "deros_runtime/runtime/refusal.hpp"
#include "deros_runtime/runtime/text.hpp"

namespace deros_runtime
{

namespace
{

// A gate that finds a second one within this time, in ns, of its start gives way.
constexpr Time EARLY = 5'000'000'000;

// Looks in a row that have to find it: one that is just ending is not taken for it.
constexpr int LOOKS = 2;

}  // namespace

TargetPublishers::TargetPublishers(
  rclcpp::Node & node, const std::string & target, Report report)
: node_(node),
  target_(node.get_node_topics_interface()->resolve_topic_name(target)),
  report_(std::move(report)),
  give_way_until_(steady_now() + EARLY)
{
}

void TargetPublishers::look()
{
  const std::string own = node_.get_fully_qualified_name();
  int gates = 0;
  std::vector<std::string> others;
  for (const rclcpp::TopicEndpointInfo & info : node_.get_publishers_info_by_topic(target_)) {
    const std::string name = node_of(info);
    if (name == own) {
      ++gates;
    } else {
      others.push_back(name.empty() ? "a node that is not known yet" : name);
    }
  }
  std::vector<std::string> faults;
  found_ = gates > 1 ? std::min(found_ + 1, LOOKS) : 0;
  if (gates > 1) {
    const std::string text = "a second gate of the name " + own + " publishes on it";
    if (found_ == LOOKS && steady_now() < give_way_until_) {
      throw Refusal(target_ + ": " + text + "; this one started last and ends now");
    }
    faults.push_back(text);
  }
  if (!others.empty()) {
    std::sort(others.begin(), others.end());
    faults.push_back("published past the gate: " + joined(others, ", "));
  }
  report_(target_, joined(faults, "; "));
}

}  // namespace deros_runtime
