// Copyright and licence: see package.xml.

#ifndef DEROS_RUNTIME_CPP__WORKER_HPP_
#define DEROS_RUNTIME_CPP__WORKER_HPP_

#include <exception>
#include <functional>
#include <mutex>
#include <thread>

#include "deros_runtime_cpp/event_loop.hpp"

namespace deros_runtime_cpp
{

/// The thread of an event loop.
class Worker
{
public:
  using Ended = std::function<void ()>;
  using Report = std::function<void (const char *)>;

  /**
   * \param report takes the text of an exception in the thread, if nobody waits for its end
   */
  Worker(EventLoop & event_loop, Report report);
  ~Worker();
  Worker(const Worker &) = delete;
  Worker & operator=(const Worker &) = delete;

  /// Start the thread, with minimal timer slack.
  void start();

  /// Stop the thread after what it is doing now, and wait for it.
  void stop();

  /// Call a function when the thread ends, or at once if it has ended.
  void when_ended(Ended ended);

  /// Return the exception that ended the thread, if one did.
  std::exception_ptr failure() const;

private:
  void run();

  EventLoop & event_loop_;
  Report report_;
  mutable std::mutex mutex_;
  bool has_ended_ = false;
  Ended ended_;
  std::exception_ptr failure_;
  std::thread thread_;
};

}  // namespace deros_runtime_cpp

#endif  // DEROS_RUNTIME_CPP__WORKER_HPP_
