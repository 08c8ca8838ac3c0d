#include "deros_runtime/runtime/process.hpp"

#include <pthread.h>
#include <semaphore.h>
#include <signal.h>

#include <cerrno>
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

sem_t asked_to_end;  // posted by the handler, which may do little else

void take_signal([[maybe_unused]] int number)
{
  const int kept = errno;
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
