// Copyright and licence: see package.xml.

#include "deros_runtime_cpp/worker.hpp"

#include <exception>
#include <mutex>
#include <string>
#include <thread>
#include <utility>

#include "deros_runtime_cpp/realtime.hpp"

namespace deros_runtime_cpp
{

Worker::Worker(EventLoop & event_loop, Report report)
: event_loop_(event_loop), report_(std::move(report))
{
}

Worker::~Worker()
{
  stop();
}

void Worker::start()
{
  thread_ = std::thread([this] {run();});
}

void Worker::stop()
{
  event_loop_.stop();
  if (thread_.joinable()) {
    thread_.join();
  }
}

void Worker::when_ended(Ended ended)
{
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (!has_ended_) {
      ended_ = std::move(ended);
      return;
    }
  }
  ended();
}

std::exception_ptr Worker::failure() const
{
  const std::lock_guard<std::mutex> lock(mutex_);
  return failure_;
}

void Worker::run()
{
  minimize_timer_slack();
  std::exception_ptr failure;
  std::string why = "something was thrown that is not a std::exception";
  try {
    event_loop_.run();
  } catch (const std::exception & error) {
    failure = std::current_exception();
    why = error.what();
  } catch (...) {
    failure = std::current_exception();
  }
  Ended ended;
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    has_ended_ = true;
    failure_ = failure;
    ended = std::move(ended_);
  }
  if (ended) {
    ended();
  } else if (failure) {
    report_(why.c_str());
  }
}

}  // namespace deros_runtime_cpp
