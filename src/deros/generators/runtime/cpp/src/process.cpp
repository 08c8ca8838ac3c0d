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

// How often a request to end is repeated: one before the executor spins is not heard.
constexpr std::chrono::milliseconds AGAIN{20};

sem_t asked_to_end;  // posted by the handler, which may do little else
std::atomic<bool> has_been_told{false};  // by a signal
std::atomic<bool> is_running{false};

/// Let no code within a node end the process as if it had been told to end.
void fail_at_exit()
{
  if (is_running) {
    constexpr std::string_view why = "the node was ended by exit() within it\n";
    [[maybe_unused]] const ssize_t count = ::write(STDERR_FILENO, why.data(), why.size());
    ::_exit(1);
  }
}

/// Have exit() call it before all that has been registered up to now.
void watch_over_exit()
{
  std::atexit(fail_at_exit);
  std::at_quick_exit(fail_at_exit);
}

void take_signal([[maybe_unused]] int number)
{
  const int kept = errno;
  has_been_told = true;
  sem_post(&asked_to_end);
  errno = kept;
}

/// SIGINT and SIGTERM as a request, which interrupts no thread in what it is at.
class StopSignals
{
public:
  StopSignals()
  {
    sem_init(&asked_to_end, 0, 0);
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

  /// Ask as a signal does.
  void ask() const
  {
    sem_post(&asked_to_end);
  }

  /// Wait until it is asked for, in a thread of its own.
  void wait() const
  {
    pthread_sigmask(SIG_UNBLOCK, &set_, nullptr);
    while (sem_wait(&asked_to_end) != 0) {  // interrupted by the signal itself
    }
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
  living.when_ended([&signals] {signals.ask();});
  std::exception_ptr failure;
  try {
    executor.spin();
  } catch (...) {
    failure = std::current_exception();
  }
  signals.ask();  // whatever has ended it, the listener is to end, too
  spun.set_value();
  living.stop();
  listener.join();
  if (failure) {
    std::rethrow_exception(failure);
  }
  if (const std::exception_ptr thrown = living.failure()) {
    std::rethrow_exception(thrown);
  }
  if (!has_been_told) {
    throw Refusal("the context of ROS 2 was shut down within the node, which ends now");
  }
}

}  // namespace

int run(int argc, char ** argv, const std::function<Living()> & make)
{
  never_wait_for_readers();
  sharpen_timers();  // before any thread of the middleware starts, so that it inherits them
  const StopSignals signals;
  int code = 1;
  is_running = true;
  watch_over_exit();
  try {
    rclcpp::init(argc, argv, rclcpp::InitOptions(), rclcpp::SignalHandlerOptions::None);
    const Living living = make();
    watch_over_exit();  // before what libraries have registered meanwhile
    spin(living, signals);
    code = 0;
  } catch (const std::exception & error) {
    std::fprintf(stderr, "%s\n", error.what());
  } catch (...) {
    std::fprintf(stderr, "what was thrown in the node says nothing of itself\n");
  }
  rclcpp::shutdown();
  is_running = false;
  return code;
}

}  // namespace deros_runtime_cpp
