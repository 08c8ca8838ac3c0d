#ifndef DEROS_RUNTIME__RUNTIME__PUBLISHERS_HPP_
#define DEROS_RUNTIME__RUNTIME__PUBLISHERS_HPP_

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

#include "rclcpp/rclcpp.hpp"

namespace deros_runtime
{

/// Looks, one topic at a time, for publishers that a node cannot hear.
/**
 * They have another type or an unfit quality of service. The middleware keeps silent about the
 * first, and does not say when the second ends.
 */
class Publishers
{
public:
  /// Takes a topic and what is wrong with it, empty if nothing is.
  using Report = std::function<void (const std::string &, const std::string &)>;

  Publishers(rclcpp::Node & node, Report report);

  /// Watch over a topic.
  void add(const rclcpp::SubscriptionBase & subscription, const std::string & type);

  /// Look at the next topic.
  void look();

private:
  struct Topic
  {
    std::string name;
    std::string type;
    rclcpp::QoS qos;
  };

  std::string faults(const Topic & topic) const;

  rclcpp::Node & node_;
  Report report_;
  std::vector<Topic> topics_;
  std::size_t next_ = 0;
};

}  // namespace deros_runtime

#endif  // DEROS_RUNTIME__RUNTIME__PUBLISHERS_HPP_
