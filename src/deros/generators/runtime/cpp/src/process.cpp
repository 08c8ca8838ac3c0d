// Copyright and licence: see package.xml.

#include "deros_runtime_cpp/process.hpp"

#include <pthread.h>
#include <semaphore.h>
#include <signal.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <functional>
#include <future>
#include <string_view>
#include <thread>

#include "deros_runtime_cpp/realtime.hpp"
#include "deros_runtime_cpp/refusal.hpp"

namespace deros_runtime_cpp
{

namespace
{

// How often a request to stop is repeated: one before the executor spins has no effect.
constexpr std::chrono::milliseconds REPETITION_PERIOD{20};

sem_t stop_requests;  // posted by the signal handler, which may do little else
std::atomic<bool> has_received_signal{false};
std::atomic<bool> is_running{false};

/// Make exit() within a node a failure, not a requested end.
void fail_at_exit()
{
  if (is_running) {
    constexpr std::string_view why = "the node was ended by exit() within it\n";
    [[maybe_unused]] const ssize_t count = ::write(STDERR_FILENO, why.data(), why.size());
    ::_exit(1);
  }
}

/// Have exit() call fail_at_exit() before all functions registered up to now.
void register_exit_check()
{
  std::atexit(fail_at_exit);
  std::at_quick_exit(fail_at_exit);
}

void take_signal([[maybe_unused]] int number)
{
  const int previous = errno;
  has_received_signal = true;
  sem_post(&stop_requests);
  errno = previous;
}

/// SIGINT and SIGTERM as requests to stop, which interrupt no thread.
class StopSignals
{
public:
  StopSignals()
  {
    sem_init(&stop_requests, 0, 0);
    struct sigaction action{};
    action.sa_handler = take_signal;
    action.sa_flags = SA_RESTART;
    sigemptyset(&set_);
    for (const int number : {SIGINT, SIGTERM}) {
      sigaddset(&set_, number);
      sigaction(number, &action, nullptr);  // for threads that libraries have started before
    }
    pthread_sigmask(SIG_BLOCK, &set_, nullptr);  // for all threads that are started from now on
  }

  /// Request a stop, as a signal does.
  void request() const
  {
    sem_post(&stop_requests);
  }

  /// Wait for a request, in a separate thread.
  void wait() const
  {
    pthread_sigmask(SIG_UNBLOCK, &set_, nullptr);
    while (sem_wait(&stop_requests) != 0) {  // interrupted by the signal itself
    }
  }

private:
  sigset_t set_;
};

/// Spin until a signal is received, or the node ends.
void spin(const RunnableNode & running, const StopSignals & signals)
{
  rclcpp::executors::SingleThreadedExecutor executor;
  executor.add_node(running.node);
  std::promise<void> spun;
  std::thread listener([&signals, &executor, &spun] {
      signals.wait();
      const std::future<void> over = spun.get_future();
      do {
        executor.cancel();
      } while (over.wait_for(REPETITION_PERIOD) != std::future_status::ready);
    });
  running.when_ended([&signals] {signals.request();});
  std::exception_ptr failure;
  try {
    executor.spin();
  } catch (...) {
    failure = std::current_exception();
  }
  signals.request();  // the listener has to end, too
  spun.set_value();
  running.stop();
  listener.join();
  if (failure) {
    std::rethrow_exception(failure);
  }
  if (const std::exception_ptr thrown = running.failure()) {
    std::rethrow_exception(thrown);
  }
  if (!has_received_signal) {
    throw Refusal("the context of ROS 2 was shut down within the node, which ends now");
  }
}

}  // namespace

int run(int argc, char ** argv, const std::function<RunnableNode()> & make)
{
  make_output_nonblocking();
  minimize_timer_slack();  // before any thread of the middleware starts, so that it inherits them
  const StopSignals signals;
  int code = 1;
  is_running = true;
  register_exit_check();
  try {
    rclcpp::init(argc, argv, rclcpp::InitOptions(), rclcpp::SignalHandlerOptions::None);
    const RunnableNode running = make();
    register_exit_check();  // before the functions that libraries have registered in the meantime
    spin(running, signals);
    code = 0;
  } catch (const std::exception & error) {
    std::fprintf(stderr, "%s\n", error.what());
  } catch (...) {
    std::fprintf(stderr, "the node threw something that is not a std::exception\n");
  }
  rclcpp::shutdown();
  is_running = false;
  return code;
}

}  // namespace deros_runtime_cpp
