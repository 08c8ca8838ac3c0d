// Copyright and licence: see package.xml.

#include "deros_runtime_cpp/safety_source.hpp"

#include <algorithm>
#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "deros_runtime_cpp/endpoints.hpp"
#include "deros_runtime_cpp/text.hpp"

namespace deros_runtime_cpp
{

namespace
{

constexpr std::size_t MAX_UNKNOWN = 64;  // publishers on one topic; with more, none is trusted

/// Return the item with an identifier, or the end.
template<typename Items, typename Gid>
auto find(Items & items, const Gid & gid)
{
  return std::find_if(
    items.begin(), items.end(), [&gid](const auto & each) {return each.gid == gid;});
}

/// Return the publisher with an identifier, or the end.
template<typename Infos, typename Gid>
auto find_info(const Infos & infos, const Gid & gid)
{
  return std::find_if(
    infos.begin(), infos.end(), [&gid](const auto & each) {return each.endpoint_gid() == gid;});
}

}  // namespace

SafetySource::SafetySource(rclcpp::Node & node, Time silence, Report report)
: node_(node), silence_(silence), report_(std::move(report))
{
}

void SafetySource::add_heartbeat(SubscribedTopic topic)
{
  heartbeat_ = std::move(topic);
}

std::size_t SafetySource::add_state(SubscribedTopic topic)
{
  topics_.push_back({std::move(topic), {}, {}});
  return topics_.size() - 1;
}

SafetySource::Gid SafetySource::gid_of(const rclcpp::MessageInfo & info)
{
  Gid gid{};
  const auto & data = info.get_rmw_message_info().publisher_gid.data;
  std::copy(std::begin(data), std::end(data), gid.begin());
  return gid;
}

// The heartbeat

SafetySource::Sender SafetySource::sender_of(const rclcpp::MessageInfo & info)
{
  const Gid gid = gid_of(info);
  const Time now = steady_now();
  if (safety_node_ && safety_node_->gid == gid) {
    safety_node_->last_message = now;
    return Sender::SAFETY_NODE;
  }
  return adopt(gid, now);
}

/// Accept a publisher of the heartbeat as the safety node, unless another node can be it.
SafetySource::Sender SafetySource::adopt(const Gid & gid, Time now)
{
  if (safety_node_) {
    seen_.push_back(*safety_node_);
    safety_node_.reset();
  }
  update_publishers(gid, now);
  const auto found = find(seen_, gid);
  if (found == seen_.end() || found->node.empty()) {
    return Sender::NOBODY;  // the graph does not know it yet, or no longer
  }
  for (const Publisher & each : seen_) {
    const bool is_past = each.node == found->node && now - each.last_message >= silence_;
    if (each.gid != gid && !is_past) {
      return Sender::NOBODY;
    }
  }
  safety_node_ = *found;
  seen_.erase(found);
  if (last_ != gid) {
    last_ = gid;
    forget_states();
  }
  return Sender::NEW_SAFETY_NODE;
}

/// Identify the publishers of the states again; those of the previous node are not trusted.
void SafetySource::forget_states()
{
  for (Topic & topic : topics_) {
    for (UnknownPublisher & publisher : topic.unknown) {
      publisher.is_other = false;
    }
    if (topic.trusted) {
      topic.unknown.push_back({*topic.trusted, false, true});
      topic.trusted.reset();
    }
  }
}

/// Update the publishers of the heartbeat, and when each sent its last message.
void SafetySource::update_publishers(const Gid & sender, Time now)
{
  std::vector<Publisher> found;
  for (const rclcpp::TopicEndpointInfo & info : matched_publishers(node_, *heartbeat_)) {
    const auto known = find(seen_, info.endpoint_gid());
    const bool is_new = known == seen_.end() || info.endpoint_gid() == sender;
    found.push_back({info.endpoint_gid(), node_of(info), is_new ? now : known->last_message});
  }
  seen_ = std::move(found);
}

// States

bool SafetySource::is_trusted(
  std::size_t topic, const rclcpp::MessageInfo & info, bool is_active)
{
  Topic & from = topics_[topic];
  const Gid gid = gid_of(info);
  if (from.trusted != gid) {
    auto publisher = find(from.unknown, gid);
    if (publisher == from.unknown.end()) {
      if (from.unknown.size() == MAX_UNKNOWN) {
        return false;
      }
      publisher = from.unknown.insert(publisher, {gid, is_active, false});
    }
    publisher->is_active = is_active;
    if (!is_of_safety_node(from, *publisher)) {
      return false;
    }
    from.trusted = gid;
    from.unknown.erase(publisher);
  }
  return (!heartbeat_ || safety_node_) && from.unknown.size() < MAX_UNKNOWN && std::none_of(
    from.unknown.begin(), from.unknown.end(),
    [](const UnknownPublisher & each) {return each.is_active;});
}

/// Return whether a publisher of states is the safety node; the graph is queried once.
bool SafetySource::is_of_safety_node(const Topic & topic, UnknownPublisher & publisher) const
{
  if (publisher.is_other || (heartbeat_ && !safety_node_)) {
    return false;
  }
  const auto infos = matched_publishers(node_, topic.subscribed);
  const auto info = find_info(infos, publisher.gid);
  if (info == infos.end() || node_of(*info).empty()) {
    return false;
  }
  if (!heartbeat_) {
    return infos.size() == 1 && node_of(*info) == only_state_node();
  }
  const auto beating = matched_publishers(node_, *heartbeat_);
  if (find_info(beating, safety_node_->gid) == beating.end()) {
    return false;  // it is gone; this may be the next one, whose heartbeat has not been received
  }
  publisher.is_other = topic.trusted.has_value() || node_of(*info) != safety_node_->node;
  return !publisher.is_other;
}

/// Return the only node that publishes states, one publisher per topic; empty if there is none.
std::string SafetySource::only_state_node() const
{
  std::string found;
  for (const Topic & topic : topics_) {
    for (const rclcpp::TopicEndpointInfo & info : matched_publishers(node_, topic.subscribed)) {
      const std::string name = node_of(info);
      if (name.empty() || (!found.empty() && found != name)) {
        return "";
      }
      found = name;
    }
  }
  return found;
}

// Once a second

bool SafetySource::check()
{
  bool is_alone = true;
  for (Topic & topic : topics_) {
    check_topic(topic);
    is_alone = is_alone && (heartbeat_ || topic.unknown.empty());
  }
  if (!safety_node_) {
    return is_alone;
  }
  for (const rclcpp::TopicEndpointInfo & info : matched_publishers(node_, *heartbeat_)) {
    is_alone = is_alone && node_of(info) == safety_node_->node;
  }
  if (!is_alone) {
    seen_.push_back(*safety_node_);
    safety_node_.reset();
  }
  return is_alone;
}

/// Remove publishers that are gone, and report those of other nodes.
void SafetySource::check_topic(Topic & topic)
{
  const auto infos = matched_publishers(node_, topic.subscribed);
  const auto is_gone = [&infos](const Gid & gid) {return find_info(infos, gid) == infos.end();};
  topic.unknown.erase(
    std::remove_if(
      topic.unknown.begin(), topic.unknown.end(),
      [&is_gone](const UnknownPublisher & each) {return is_gone(each.gid);}),
    topic.unknown.end());
  if (topic.trusted && (is_gone(*topic.trusted) || (!heartbeat_ && infos.size() > 1))) {
    topic.trusted.reset();
  }
  const std::string safety_node = safety_node_ ? safety_node_->node : "";
  std::vector<std::string> names;
  for (UnknownPublisher & each : topic.unknown) {
    const std::string name = node_of(*find_info(infos, each.gid));
    if (!topic.trusted && name == safety_node) {
      each.is_other = false;  // it was not trusted beside the publisher that is gone now
    }
    if (each.is_other) {
      names.push_back(name);
    }
  }
  std::sort(names.begin(), names.end());
  report_(
    "state on " + topic.subscribed.name,
    names.empty() ?
    "" : joined(names, ", ") + " publishes it, not the safety node " + safety_node);
}

}  // namespace deros_runtime_cpp
