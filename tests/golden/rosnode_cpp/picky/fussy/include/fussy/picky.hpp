// Copyright and licence: see package.xml.

// The node picky: yours to fill in. deros wrote this file once and leaves it alone.

#ifndef FUSSY__PICKY_HPP_
#define FUSSY__PICKY_HPP_

#include "fussy/picky_base.hpp"
#include "rclcpp/rclcpp.hpp"
#include "std_msgs/msg/empty.hpp"
#include "std_srvs/srv/set_bool.hpp"

namespace fussy
{

/// Takes "nothing" but the best, and To do says so in C:/.
class Picky : public PickyBase
{
public:
  /// Start the node; everything must be ready before the first handler runs.
  explicit Picky(const rclcpp::NodeOptions & options);

protected:
  void on_class_(const std_msgs::msg::Empty & msg) override;
  void on_while_() override;
  void handle_struct_(
    const std_srvs::srv::SetBool::Request & request,
    std_srvs::srv::SetBool::Response & response) override;
};

}  // namespace fussy

#endif  // FUSSY__PICKY_HPP_
