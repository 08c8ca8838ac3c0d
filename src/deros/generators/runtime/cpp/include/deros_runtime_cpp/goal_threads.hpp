// Copyright and licence: see package.xml.

/// \file
/// The threads that execute the goals of the actions of a node.

#ifndef DEROS_RUNTIME_CPP__GOAL_THREADS_HPP_
#define DEROS_RUNTIME_CPP__GOAL_THREADS_HPP_

#include <cstddef>
#include <functional>
#include <memory>
#include <string>
#include <utility>

#include "rclcpp/rclcpp.hpp"
#include "rclcpp_action/rclcpp_action.hpp"

namespace deros_runtime_cpp
{

/// Executes each goal in a separate thread: no goal delays messages, cancels or parameters.
/**
 * Each thread shares the ownership of the node, which is therefore destroyed after its goals have
 * returned, even if it is unloaded before. When ROS 2 shuts down, or when only its goals still own
 * the node, the goals are aborted: their code sees that they are no longer executing, and returns.
 */
class GoalThreads
{
public:
  GoalThreads(rclcpp::Context::SharedPtr context, const rclcpp::Logger & logger);
  ~GoalThreads();
  GoalThreads(const GoalThreads &) = delete;
  GoalThreads & operator=(const GoalThreads &) = delete;

  /// Return whether a goal can be accepted; log why it cannot.
  /**
   * \param action the name of the goal's action
   * \param limit the maximum number of goals in execution at the same time
   */
  bool accepts(const std::string & action, std::size_t limit);

  /// Start the execution of a goal.
  /**
   * \param node the node, which lives at least until the goal has returned
   * \param handler the name of the function that executes goals
   * \param execute the function
   */
  template<typename ActionT, typename ExecuteT>
  void start(
    std::shared_ptr<void> node, const char * handler,
    const std::shared_ptr<rclcpp_action::ServerGoalHandle<ActionT>> & goal_handle,
    ExecuteT execute)
  {
    const auto abort = [goal_handle] {
        if (!goal_handle->is_active()) {
          return false;
        }
        if (!goal_handle->is_executing() && !goal_handle->is_canceling()) {
          goal_handle->execute();  // it was deferred; only an executing goal can be aborted
        }
        goal_handle->abort(std::make_shared<typename ActionT::Result>());
        return true;
      };
    launch(std::move(node), Goal{handler, [goal_handle, execute] {execute(*goal_handle);}, abort});
  }

  /// Return whether a goal is in execution.
  bool is_busy() const;

private:
  struct Goal
  {
    const char * handler{""};
    std::function<void()> execute{};
    std::function<bool()> abort{};  // returns false if the goal is already in a terminal state
  };
  struct Shared;

  void launch(std::shared_ptr<void> node, Goal goal);

  const rclcpp::Context::SharedPtr context_;
  const std::shared_ptr<Shared> shared_;  // with the threads
  const rclcpp::PreShutdownCallbackHandle before_shutdown_;
  const rclcpp::OnShutdownCallbackHandle on_shutdown_;
};

}  // namespace deros_runtime_cpp

#endif  // DEROS_RUNTIME_CPP__GOAL_THREADS_HPP_
