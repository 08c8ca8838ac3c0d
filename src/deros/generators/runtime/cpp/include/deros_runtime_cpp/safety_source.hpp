// Copyright and licence: see package.xml.

/// \file
/// The safety node as the source of heartbeats and states: a gate obeys no other node.

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

/// Identifies the messages of the safety node by the identifiers of their publishers.
/**
 * The safety node is the node of the only publisher of the heartbeat; for a gate without a line
 * about the heartbeat, the node of the only publishers of the states. The graph is queried when a
 * message comes from a new publisher, and once a second for all publishers.
 */
class SafetySource
{
public:
  /// Takes the subject and the text of a fault; an empty text clears it.
  using Report = std::function<void (const std::string &, const std::string &)>;

  /// The sender of a heartbeat.
  enum class Sender
  {
    SAFETY_NODE,  // the same publisher as before
    NEW_SAFETY_NODE,  // whose state is unknown
    NOBODY  // none or several nodes: there is no safety node now
  };

  /**
   * \param silence how long, in ns, a publisher of the heartbeat that is still in the graph, like
   *   that of a killed process, has to be silent before one of the same node name replaces it
   */
  SafetySource(rclcpp::Node & node, Time silence, Report report);

  /// Identify the publishers of the heartbeat.
  void add_heartbeat(SubscribedTopic topic);

  /// Identify the publishers of a topic with states; return its number.
  std::size_t add_state(SubscribedTopic topic);

  /// Return the sender of a heartbeat.
  Sender sender_of(const rclcpp::MessageInfo & info);

  /// Return whether the publishers allow a state to release the robot.
  /**
   * The state has to come from the safety node, and no other node may report an active action.
   * \param is_active whether any action is active, or the message cannot be deserialized
   */
  bool is_trusted(std::size_t topic, const rclcpp::MessageInfo & info, bool is_active);

  /// Query the graph; return whether no other node can be the safety node.
  bool check();

private:
  using Gid = std::array<std::uint8_t, RMW_GID_STORAGE_SIZE>;

  /// A publisher of the heartbeat.
  struct Publisher
  {
    Gid gid;
    std::string node;
    Time last_message;  // or when it was discovered
  };

  /// A publisher of states that is not known to be the safety node.
  struct UnknownPublisher
  {
    Gid gid;
    bool is_active;
    bool is_other;  // known to be another node
  };

  struct Topic
  {
    SubscribedTopic subscribed;
    std::optional<Gid> trusted;
    std::vector<UnknownPublisher> unknown;
  };

  static Gid gid_of(const rclcpp::MessageInfo & info);
  Sender adopt(const Gid & gid, Time now);
  void forget_states();
  void update_publishers(const Gid & sender, Time now);
  bool is_of_safety_node(const Topic & topic, UnknownPublisher & publisher) const;
  std::string only_state_node() const;
  void check_topic(Topic & topic);

  rclcpp::Node & node_;
  const Time silence_;
  Report report_;
  std::optional<SubscribedTopic> heartbeat_;  // none if the gate has no line about it
  std::optional<Publisher> safety_node_;
  std::optional<Gid> last_;  // the last publisher of the heartbeat of the safety node
  std::vector<Publisher> seen_;  // of the heartbeat
  std::vector<Topic> topics_;
};

}  // namespace deros_runtime_cpp

#endif  // DEROS_RUNTIME_CPP__SAFETY_SOURCE_HPP_
