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
   * \param report takes what is thrown in the thread, if nobody waits for its end
   */
  Worker(EventLoop & event_loop, Report report);
  ~Worker();
  Worker(const Worker &) = delete;
  Worker & operator=(const Worker &) = delete;

  /// Start; prepared for waits that end on time.
  void start();

  /// End the thread, when it has done what it is at, and wait for that.
  void stop();

  /// Have a function called when the thread ends, or at once if it has ended.
  void when_ended(Ended ended);

  /// Return what was thrown, if that ended the thread.
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
