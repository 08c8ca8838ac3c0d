#include "deros_runtime/runtime/process.hpp"

#include <pthread.h>
#include <signal.h>

#include <chrono>
#include <cstdio>
#include <exception>
#include <functional>
#include <future>
#include <thread>

#include "deros_runtime/runtime/machine.hpp"

namespace deros_runtime
{

namespace
{

// How often a request to end is repeated: one before the executor spins is not heard.
constexpr std::chrono::milliseconds AGAIN{20};

/// SIGINT and SIGTERM, which no thread is interrupted by while this lives.
class StopSignals
{
public:
  StopSignals()
  {
    sigemptyset(&set_);
    sigaddset(&set_, SIGINT);
    sigaddset(&set_, SIGTERM);
    pthread_sigmask(SIG_BLOCK, &set_, nullptr);  // for all threads that are started from now on
  }

  /// Wait for one.
  void wait() const
  {
    int number = 0;
    sigwait(&set_, &number);
  }

private:
  sigset_t set_;
};

/// Spin until a signal comes, or the node ends.
void spin(const Living & living, const StopSignals & signals)
{
  rclcpp::executors::SingleThreadedExecutor executor;
  executor.add_node(living.node);
  std::promise<void> spun;
  std::thread listener([&signals, &executor, &spun] {
      signals.wait();
      const std::future<void> over = spun.get_future();
      do {
        executor.cancel();
      } while (over.wait_for(AGAIN) != std::future_status::ready);
    });
  const pthread_t thread = listener.native_handle();
  living.when_ended([thread] {pthread_kill(thread, SIGTERM);});
  std::exception_ptr failure;
  try {
    executor.spin();
  } catch (...) {
    failure = std::current_exception();
    pthread_kill(thread, SIGTERM);
  }
  spun.set_value();
  living.stop();  // may still signal the listener, so that is joined last
  listener.join();
  if (failure) {
    std::rethrow_exception(failure);
  }
}

}  // namespace

int run(int argc, char ** argv, const std::function<Living()> & make)
{
  never_wait_for_readers();
  sharpen_timers();  // before any thread of the middleware starts, so that it inherits them
  const StopSignals signals;
  int code = 0;
  try {
    rclcpp::init(argc, argv, rclcpp::InitOptions(), rclcpp::SignalHandlerOptions::None);
    const Living living = make();
    spin(living, signals);
    if (const std::exception_ptr failure = living.failure()) {
      std::rethrow_exception(failure);
    }
  } catch (const std::exception & error) {
    std::fprintf(stderr, "%s\n", error.what());
    code = 1;
  }
  rclcpp::shutdown();
  return code;
}

}  // namespace deros_runtime
