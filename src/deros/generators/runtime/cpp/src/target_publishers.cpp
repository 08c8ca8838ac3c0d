// Copyright and licence: see package.xml.

#include "deros_runtime_cpp/target_publishers.hpp"

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "deros_runtime_cpp/endpoints.hpp"
#include "deros_runtime_cpp/publishers.hpp"
#include "deros_runtime_cpp/refusal.hpp"
#include "deros_runtime_cpp/text.hpp"

namespace deros_runtime_cpp
{

namespace
{

// In ns, as long as a second gate may have started at the same time.
constexpr Time PERIOD = 100'000'000;

// In ns after the start; a gate that finds a second one while it is young has ended by then.
constexpr Time EARLY = 2 * StartOrder::YOUNG;

}  // namespace

TargetPublisherCheck::TargetPublisherCheck(
  EventLoop & event_loop, rclcpp::Node & node, const std::string & target, Report report)
: node_(node),
  target_(node.get_node_topics_interface()->resolve_topic_name(target)),
  report_(std::move(report)),
  order_(steady_now()),
  early_until_(steady_now() + EARLY),
  early_(event_loop, Clock(), [this] {check_early();})
{
}

void TargetPublisherCheck::start()
{
  early_.schedule(0);
}

void TargetPublisherCheck::check_early()
{
  if (early_.due() < early_until_) {
    early_.repeat(PERIOD);
  }
  find();
}

void TargetPublisherCheck::check()
{
  auto [others, second] = find();
  std::vector<std::string> faults;
  if (!second.empty()) {
    faults.push_back(second);
  }
  if (!others.empty()) {
    std::sort(others.begin(), others.end());
    faults.push_back("published past the gate: " + joined(others, ", "));
  }
  report_(target_, joined(faults, "; "));
  report_("readers of " + target_, unmatched_subscriptions(node_, target_));
}

/// Return the nodes that publish past the gate, and the fault that a second gate is.
std::pair<std::vector<std::string>, std::string> TargetPublisherCheck::find()
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
  const std::string text = "a second gate of the name " + own + " publishes on it";
  if (order_.gives_way(gates > 1, steady_now())) {
    throw Refusal(target_ + ": " + text + "; this one started last and ends now");
  }
  return {others, gates > 1 ? text : ""};
}

}  // namespace deros_runtime_cpp
