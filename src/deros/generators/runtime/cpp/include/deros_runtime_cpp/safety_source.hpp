// Copyright and licence: see package.xml.

/// \file
/// The safety node as the source of heartbeats and states: a gate obeys it, and nobody else.

#ifndef DEROS_RUNTIME_CPP__SAFETY_SOURCE_HPP_
#define DEROS_RUNTIME_CPP__SAFETY_SOURCE_HPP_

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "deros_runtime_cpp/event_loop.hpp"
#include "deros_runtime_cpp/publishers.hpp"
#include "rclcpp/rclcpp.hpp"

namespace deros_runtime_cpp
{

/// Tells by the identifier in each message whether the safety node has sent it.
/**
 * The safety node is the node of the heartbeat's only publisher; a gate without a line about the
 * heartbeat takes the node of the states' only publishers for it. The graph is asked about a
 * publisher that has not been heard before, and once a second about all of them.
 */
class SafetySource
{
public:
  /// Takes what is wrong with something; an empty text takes it back.
  using Report = std::function<void (const std::string &, const std::string &)>;

  /// Who has sent a heartbeat.
  enum class Sender
  {
    SAFETY_NODE,  // the same as before
    NEW_SAFETY_NODE,  // of which nothing is known
    NOBODY  // or more than one: there is no safety node now
  };

  /**
   * \param silence how long, in ns, a publisher of the heartbeat that is still in the graph, as
   *   that of a killed process is, has to be silent before one of the same name takes its place
   */
  SafetySource(rclcpp::Node & node, Time silence, Report report);

  /// MonitorRunner over the publishers of the heartbeat.
  void add_heartbeat(SubscribedTopic topic);

  /// MonitorRunner over the publishers of a topic with states; return its number.
  std::size_t add_state(SubscribedTopic topic);

  /// Return who has sent a heartbeat.
  Sender sender_of(const rclcpp::MessageInfo & info);

  /// Tell whether a state may free the robot, as far as publishers are concerned.
  /**
   * It has to come from the safety node, and nobody else may say that an action is active.
   * \param is_active whether any action is, or the message cannot be read
   */
  bool is_trusted(std::size_t topic, const rclcpp::MessageInfo & info, bool is_active);

  /// Look at the graph; return whether no one but the safety node can be it.
  bool look();

private:
  using Gid = std::array<std::uint8_t, RMW_GID_STORAGE_SIZE>;

  /// Somebody who publishes the heartbeat.
  struct Publisher
  {
    Gid gid;
    std::string node;
    Time heard;  // or first seen
  };

  /// Somebody who publishes states, and is not known to be the safety node.
  struct Stranger
  {
    Gid gid;
    bool is_active;
    bool is_known;  // not to be the safety node
  };

  struct Topic
  {
    SubscribedTopic subscribed;
    std::optional<Gid> trusted;
    std::vector<Stranger> strangers;
  };

  static Gid gid_of(const rclcpp::MessageInfo & info);
  Sender adopt(const Gid & gid, Time now);
  void forget_states();
  void note_publishers(const Gid & heard, Time now);
  bool is_of_safety_node(const Topic & topic, Stranger & stranger) const;
  std::string only_state_node() const;
  void look_at(Topic & topic);

  rclcpp::Node & node_;
  const Time silence_;
  Report report_;
  std::optional<SubscribedTopic> heartbeat_;  // none: the gate has no line about it
  std::optional<Publisher> safety_node_;
  std::optional<Gid> last_;  // publisher of the heartbeat that was the safety node's
  std::vector<Publisher> seen_;  // of the heartbeat
  std::vector<Topic> topics_;
};

}  // namespace deros_runtime_cpp

#endif  // DEROS_RUNTIME_CPP__SAFETY_SOURCE_HPP_
