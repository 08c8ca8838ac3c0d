// Copyright and licence: see package.xml.

// The event loop: sources are served in order, timers fire when they are due, nothing is lost.

#include <cstddef>
#include <cstdio>
#include <cstdlib>
#include <stdexcept>
#include <thread>
#include <vector>

#include "deros_runtime_cpp/event_loop.hpp"
#include "deros_runtime_cpp/worker.hpp"

namespace
{

using deros_runtime_cpp::Clock;
using deros_runtime_cpp::EventLoop;
using deros_runtime_cpp::OneShotTimer;
using deros_runtime_cpp::Time;
using deros_runtime_cpp::Worker;
using deros_runtime_cpp::steady_now;

constexpr Time MILLISECOND = 1'000'000;

void require(bool condition, const char * what)
{
  if (!condition) {
    std::printf("failed: %s\n", what);
    std::exit(1);
  }
}

void items_are_processed_in_order_of_arrival()
{
  EventLoop event_loop;
  std::vector<int> done;
  const std::size_t first = event_loop.add_source([&] {done.push_back(1);}, 2);
  const std::size_t second = event_loop.add_source([&] {done.push_back(2);}, 10);
  const std::size_t last = event_loop.add_source([&] {event_loop.stop();}, 1);
  event_loop.notify(second);
  event_loop.notify(first, 5);  // there is room for two
  event_loop.notify(second, 2);
  event_loop.notify(last);
  event_loop.run();
  require(done == std::vector<int>({2, 1, 1, 2, 2}), "items are processed in order of arrival");
}

void timer_fires_during_a_flood_of_items()
{
  EventLoop event_loop;
  std::size_t flood = 0;
  flood = event_loop.add_source([&] {event_loop.notify(flood);}, 1);
  OneShotTimer timer(event_loop, Clock(), [&] {event_loop.stop();});
  timer.schedule(steady_now() + 5 * MILLISECOND);
  event_loop.notify(flood);
  event_loop.run();
}

void timer_is_never_early_and_repeats()
{
  EventLoop event_loop;
  const Time start = steady_now();
  std::vector<Time> fired;
  OneShotTimer timer(
    event_loop, Clock(), [&] {
      fired.push_back(steady_now());
      if (fired.size() == 3) {
        event_loop.stop();
      }
      timer.repeat(2 * MILLISECOND);
    });
  timer.schedule(start + 3 * MILLISECOND);
  event_loop.run();
  for (std::size_t i = 0; i < fired.size(); ++i) {
    const Time due = start + static_cast<Time>(3 + 2 * i) * MILLISECOND;
    require(fired[i] >= due, "a timer does not fire early");
  }
}

void deferred_timer_fires_after_the_maximum_deferral()
{
  EventLoop event_loop;
  const Time start = steady_now();
  Time fired = 0;
  OneShotTimer timer(
    event_loop, Clock(), [&] {
      fired = steady_now();
      event_loop.stop();
    },
    [] {return MILLISECOND;});
  timer.schedule(start);
  event_loop.run();
  require(fired - start >= 50 * MILLISECOND, "a timer is deferred as long as it has to be");
}

void timer_of_another_clock_is_checked_after_each_item()
{
  EventLoop event_loop;
  Time simulated = 0;
  const std::size_t tick = event_loop.add_source([&] {simulated += 10;}, 10);
  OneShotTimer timer(event_loop, {[&] {return simulated;}, false}, [&] {event_loop.stop();});
  timer.schedule(30);
  event_loop.notify(tick, 3);
  event_loop.run();
  require(simulated == 30, "a timer fires at the time of its own clock");
}

void items_of_another_thread_wake_the_event_loop()
{
  EventLoop event_loop;
  int remaining = 1000;
  const std::size_t source = event_loop.add_source(
    [&] {
      if (--remaining == 0) {
        event_loop.stop();
      }
    }, 1000);
  std::thread other([&] {
      for (int i = 0; i < 1000; ++i) {
        event_loop.notify(source);
      }
    });
  event_loop.run();
  other.join();
  require(remaining == 0, "no item is lost");
}

void worker_keeps_the_exception_that_ended_it()
{
  EventLoop event_loop;
  const std::size_t source = event_loop.add_source([] {throw std::runtime_error("broken");}, 1);
  bool is_reported = false;
  Worker worker(event_loop, [&](const char *) {is_reported = true;});
  worker.start();
  event_loop.notify(source);
  worker.stop();
  require(worker.failure() != nullptr || !is_reported, "the exception is kept");
}

}  // namespace

int main()
{
  items_are_processed_in_order_of_arrival();
  timer_fires_during_a_flood_of_items();
  timer_is_never_early_and_repeats();
  deferred_timer_fires_after_the_maximum_deferral();
  timer_of_another_clock_is_checked_after_each_item();
  items_of_another_thread_wake_the_event_loop();
  worker_keeps_the_exception_that_ended_it();
  std::puts("passed");
  return 0;
}
