// Copyright and licence: see package.xml.

#include "deros_runtime_cpp/goal_threads.hpp"

#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <exception>
#include <functional>
#include <list>
#include <memory>
#include <mutex>
#include <string>
#include <system_error>
#include <thread>
#include <utility>
#include <vector>

namespace deros_runtime_cpp
{

namespace
{

// How long a shutdown waits for goals: once while they can still publish, and once afterwards.
constexpr std::chrono::milliseconds SHUTDOWN_TIMEOUT{500};

// How often it is checked, while there are goals, whether the node has other owners. There is no
// event to wait for: rclcpp calls nothing when a node is unloaded or removed from its executor, a
// std::shared_ptr calls nothing when one of several owners releases it, and the destructor, which
// the last owner calls, is too late: the goals would use a node that is being destroyed.
constexpr std::chrono::milliseconds PERIOD{50};

}  // namespace

/// The state that the threads and the node share; it outlives both.
struct GoalThreads::Shared
{
  struct Entry
  {
    Goal goal;
    std::thread thread;
    bool is_over = false;
  };

  Shared(rclcpp::Context::SharedPtr the_context, const rclcpp::Logger & the_logger)
  : context(std::move(the_context)), logger(the_logger)
  {
  }

  void run(Entry & entry, std::shared_ptr<void> node);
  void execute(const Goal & goal);
  bool abort(const Goal & goal);
  void end();
  bool wait();
  void watch(const std::weak_ptr<void> & node);
  bool is_ending();
  std::size_t running() const;

  const rclcpp::Context::SharedPtr context;
  const rclcpp::Logger logger;
  std::mutex mutex;  // of all that follows
  std::condition_variable changed;
  std::list<Entry> entries;
  std::ptrdiff_t owners = 0;  // how many goals own the node
  bool ends = false;
  std::thread watcher;
};

GoalThreads::GoalThreads(rclcpp::Context::SharedPtr context, const rclcpp::Logger & logger)
: context_(std::move(context)),
  shared_(std::make_shared<Shared>(context_, logger)),
  before_shutdown_(
    context_->add_pre_shutdown_callback(
      [shared = shared_] {
        shared->end();
        if (!shared->wait()) {
          RCLCPP_WARN(
            shared->logger, "a goal was aborted for the shutdown, and has not returned yet: "
            "its function should return when the goal is no longer executing");
        }
      })),
  on_shutdown_(
    context_->add_on_shutdown_callback(
      [shared = shared_] {
        shared->context->interrupt_all_sleep_for();
        shared->wait();
      }))
{
}

GoalThreads::~GoalThreads()
{
  context_->remove_pre_shutdown_callback(before_shutdown_);
  context_->remove_on_shutdown_callback(on_shutdown_);
  shared_->end();
  for (Shared::Entry & entry : shared_->entries) {
    if (entry.thread.get_id() == std::this_thread::get_id()) {
      entry.thread.detach();  // it was the last owner of the node, and ends with this
    } else if (entry.thread.joinable()) {
      entry.thread.join();
    }
  }
  if (shared_->watcher.joinable()) {
    shared_->watcher.join();
  }
}

bool GoalThreads::accepts(const std::string & action, std::size_t limit)
{
  std::size_t running = 0;
  {
    const std::lock_guard<std::mutex> lock(shared_->mutex);
    if (shared_->ends) {
      return false;
    }
    running = shared_->running();
  }
  if (running < limit) {
    return true;
  }
  RCLCPP_WARN(
    shared_->logger, "goal of %s rejected: %zu goals are in execution, and max_goals() is %zu",
    action.c_str(), running, limit);
  return false;
}

bool GoalThreads::is_busy() const
{
  const std::lock_guard<std::mutex> lock(shared_->mutex);
  return shared_->running() > 0;
}

void GoalThreads::launch(std::shared_ptr<void> node, Goal goal)
{
  {
    const std::lock_guard<std::mutex> lock(shared_->mutex);
    shared_->entries.remove_if(
      [](Shared::Entry & entry) {
        if (entry.is_over) {
          entry.thread.join();
        }
        return entry.is_over;
      });
    if (!shared_->ends) {
      Shared::Entry & entry = shared_->entries.emplace_back();
      entry.goal = goal;
      ++shared_->owners;
      try {
        if (!shared_->watcher.joinable()) {
          shared_->watcher = std::thread(
            [shared = shared_, watched = std::weak_ptr<void>(node)] {shared->watch(watched);});
        }
        entry.thread = std::thread(
          [shared = shared_, &entry, owned = node]() mutable {
            shared->run(entry, std::move(owned));
          });
        shared_->changed.notify_all();
        return;
      } catch (const std::system_error & error) {
        RCLCPP_ERROR(shared_->logger, "no thread for a goal: %s", error.what());
        --shared_->owners;
        shared_->entries.pop_back();
      }
    }
  }
  shared_->abort(goal);
}

// In the thread of a goal

void GoalThreads::Shared::run(Entry & entry, std::shared_ptr<void> node)
{
  execute(entry.goal);
  Goal done;
  {
    const std::lock_guard<std::mutex> lock(mutex);
    std::swap(done, entry.goal);
    --owners;  // first, so that the node never seems to be owned by goals alone
  }
  done = Goal{};
  node.reset();
  const std::lock_guard<std::mutex> lock(mutex);
  entry.is_over = true;
  changed.notify_all();
}

void GoalThreads::Shared::execute(const Goal & goal)
{
  const char * const problem = "the goal is aborted";
  try {
    goal.execute();
    if (abort(goal) && !is_ending()) {
      RCLCPP_WARN(logger, "%s has left its goal open: %s", goal.handler, problem);
    }
    return;
  } catch (const std::exception & error) {
    if (!is_ending()) {  // when it ends, what a closed goal is used for is refused
      RCLCPP_ERROR(logger, "%s: %s: %s", goal.handler, error.what(), problem);
    }
  } catch (...) {
    RCLCPP_ERROR(logger, "%s threw what is not a std::exception: %s", goal.handler, problem);
  }
  abort(goal);
}

/// Close a goal; return whether it was open.
bool GoalThreads::Shared::abort(const Goal & goal)
{
  try {
    return goal.abort();
  } catch (const std::exception &) {
    return false;  // it was closed at the same time, or its client is gone
  }
}

// In other threads

/// Abort all goals, and reject further ones.
void GoalThreads::Shared::end()
{
  std::vector<Goal> open;
  {
    const std::lock_guard<std::mutex> lock(mutex);
    ends = true;
    for (const Entry & entry : entries) {
      if (entry.goal.abort) {
        open.push_back(entry.goal);
      }
    }
  }
  changed.notify_all();
  for (const Goal & goal : open) {
    abort(goal);
  }
}

/// Wait until all goals have returned, or the timeout expires; return whether they have.
bool GoalThreads::Shared::wait()
{
  std::unique_lock<std::mutex> lock(mutex);
  return changed.wait_for(lock, SHUTDOWN_TIMEOUT, [this] {return running() == 0;});
}

/// Abort the goals of a node that only they own, as no client could cancel them any more.
void GoalThreads::Shared::watch(const std::weak_ptr<void> & node)
{
  std::unique_lock<std::mutex> lock(mutex);
  while (!ends) {
    if (owners == 0) {
      changed.wait(lock, [this] {return ends || owners > 0;});
    } else if (node.use_count() <= owners) {
      lock.unlock();
      end();
      lock.lock();
    } else {
      changed.wait_for(lock, PERIOD);
    }
  }
}

bool GoalThreads::Shared::is_ending()
{
  const std::lock_guard<std::mutex> lock(mutex);
  return ends;
}

/// Return how many goals, except that of this thread, are in execution.
std::size_t GoalThreads::Shared::running() const
{
  std::size_t count = 0;
  for (const Entry & entry : entries) {
    const bool is_own = entry.thread.get_id() == std::this_thread::get_id();
    count += entry.is_over || is_own ? 0 : 1;
  }
  return count;
}

}  // namespace deros_runtime_cpp
