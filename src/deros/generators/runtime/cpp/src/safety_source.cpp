// Copyright and licence: see package.xml.

#include "deros_runtime_cpp/safety_source.hpp"

#include <algorithm>
#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "deros_runtime_cpp/text.hpp"

namespace deros_runtime_cpp
{

namespace
{

constexpr std::size_t MOST = 64;  // strangers on one topic; from here on nobody is trusted on it

/// Return what has an identifier, or the end.
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
    safety_node_->heard = now;
    return Sender::SAFETY_NODE;
  }
  return adopt(gid, now);
}

/// Take a publisher of the heartbeat for the safety node, unless somebody else can be it.
SafetySource::Sender SafetySource::adopt(const Gid & gid, Time now)
{
  if (safety_node_) {
    seen_.push_back(*safety_node_);
    safety_node_.reset();
  }
  note_publishers(gid, now);
  const auto found = find(seen_, gid);
  if (found == seen_.end() || found->node.empty()) {
    return Sender::NOBODY;  // the graph does not know it yet, or not any more
  }
  for (const Publisher & each : seen_) {
    const bool is_past = each.node == found->node && now - each.heard >= silence_;
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

/// Find out anew whose states are the safety node's; those of the one before are not.
void SafetySource::forget_states()
{
  for (Topic & topic : topics_) {
    for (Stranger & stranger : topic.strangers) {
      stranger.is_known = false;
    }
    if (topic.trusted) {
      topic.strangers.push_back({*topic.trusted, false, true});
      topic.trusted.reset();
    }
  }
}

/// Note who publishes the heartbeat, and when each of them was heard.
void SafetySource::note_publishers(const Gid & heard, Time now)
{
  std::vector<Publisher> found;
  for (const rclcpp::TopicEndpointInfo & info : heard_publishers(node_, *heartbeat_)) {
    const auto known = find(seen_, info.endpoint_gid());
    const bool is_new = known == seen_.end() || info.endpoint_gid() == heard;
    found.push_back({info.endpoint_gid(), node_of(info), is_new ? now : known->heard});
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
    auto stranger = find(from.strangers, gid);
    if (stranger == from.strangers.end()) {
      if (from.strangers.size() == MOST) {
        return false;
      }
      stranger = from.strangers.insert(stranger, {gid, is_active, false});
    }
    stranger->is_active = is_active;
    if (!is_of_safety_node(from, *stranger)) {
      return false;
    }
    from.trusted = gid;
    from.strangers.erase(stranger);
  }
  return (!heartbeat_ || safety_node_) && from.strangers.size() < MOST && std::none_of(
    from.strangers.begin(), from.strangers.end(),
    [](const Stranger & each) {return each.is_active;});
}

/// Tell whether somebody who publishes states is the safety node; the graph is asked once.
bool SafetySource::is_of_safety_node(const Topic & topic, Stranger & stranger) const
{
  if (stranger.is_known || (heartbeat_ && !safety_node_)) {
    return false;
  }
  const auto infos = heard_publishers(node_, topic.subscribed);
  const auto info = find_info(infos, stranger.gid);
  if (info == infos.end() || node_of(*info).empty()) {
    return false;
  }
  if (!heartbeat_) {
    return infos.size() == 1 && node_of(*info) == only_state_node();
  }
  const auto beating = heard_publishers(node_, *heartbeat_);
  if (find_info(beating, safety_node_->gid) == beating.end()) {
    return false;  // that one is gone; this may be the next, of which no heartbeat has come yet
  }
  stranger.is_known = topic.trusted.has_value() || node_of(*info) != safety_node_->node;
  return !stranger.is_known;
}

/// Return the node of all states, each topic of which has one publisher; empty if there is none.
std::string SafetySource::only_state_node() const
{
  std::string found;
  for (const Topic & topic : topics_) {
    for (const rclcpp::TopicEndpointInfo & info : heard_publishers(node_, topic.subscribed)) {
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

bool SafetySource::look()
{
  bool is_alone = true;
  for (Topic & topic : topics_) {
    look_at(topic);
    is_alone = is_alone && (heartbeat_ || topic.strangers.empty());
  }
  if (!safety_node_) {
    return is_alone;
  }
  for (const rclcpp::TopicEndpointInfo & info : heard_publishers(node_, *heartbeat_)) {
    is_alone = is_alone && node_of(info) == safety_node_->node;
  }
  if (!is_alone) {
    seen_.push_back(*safety_node_);
    safety_node_.reset();
  }
  return is_alone;
}

/// Forget who is gone, and report who is there and is not the safety node.
void SafetySource::look_at(Topic & topic)
{
  const auto infos = heard_publishers(node_, topic.subscribed);
  const auto is_gone = [&infos](const Gid & gid) {return find_info(infos, gid) == infos.end();};
  topic.strangers.erase(
    std::remove_if(
      topic.strangers.begin(), topic.strangers.end(),
      [&is_gone](const Stranger & each) {return is_gone(each.gid);}),
    topic.strangers.end());
  if (topic.trusted && (is_gone(*topic.trusted) || (!heartbeat_ && infos.size() > 1))) {
    topic.trusted.reset();
  }
  const std::string safety_node = safety_node_ ? safety_node_->node : "";
  std::vector<std::string> names;
  for (Stranger & each : topic.strangers) {
    const std::string name = node_of(*find_info(infos, each.gid));
    if (!topic.trusted && name == safety_node) {
      each.is_known = false;  // beside the one that is gone now, it was not believed
    }
    if (each.is_known) {
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
