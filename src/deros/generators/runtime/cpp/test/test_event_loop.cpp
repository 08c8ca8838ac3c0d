// Copyright and licence: see package.xml.

// The event loop: what comes is done in order, timers ring at their time, and nothing is lost.

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

using deros_runtime_cpp::EventLoop;
using deros_runtime_cpp::OneShotTimer;
using deros_runtime_cpp::Clock;
using deros_runtime_cpp::Time;
using deros_runtime_cpp::Worker;
using deros_runtime_cpp::steady_now;

constexpr Time MILLISECOND = 1'000'000;

void require(bool holds, const char * what)
{
  if (!holds) {
    std::printf("not so: %s\n", what);
    std::exit(1);
  }
}

void what_comes_is_done_in_its_order()
{
  EventLoop event_loop;
  std::vector<int> done;
  const std::size_t first = event_loop.add_source([&] {done.push_back(1);}, 2);
  const std::size_t second = event_loop.add_source([&] {done.push_back(2);}, 10);
  const std::size_t last = event_loop.add_source([&] {event_loop.end();}, 1);
  event_loop.notify(second);
  event_loop.notify(first, 5);  // of which two have room
  event_loop.notify(second, 2);
  event_loop.notify(last);
  event_loop.run();
  require(done == std::vector<int>({2, 1, 1, 2, 2}), "the order of what came");
}

void a_flood_starves_no_alarm()
{
  EventLoop event_loop;
  std::size_t flood = 0;
  flood = event_loop.add_source([&] {event_loop.notify(flood);}, 1);
  OneShotTimer timer(event_loop, Clock(), [&] {event_loop.end();});
  timer.schedule(steady_now() + 5 * MILLISECOND);
  event_loop.notify(flood);
  event_loop.run();
}

void an_alarm_is_never_early_and_repeats()
{
  EventLoop event_loop;
  const Time start = steady_now();
  std::vector<Time> rung;
  OneShotTimer timer(
    event_loop, Clock(), [&] {
      rung.push_back(steady_now());
      if (rung.size() == 3) {
        event_loop.end();
      }
      timer.repeat(2 * MILLISECOND);
    });
  timer.schedule(start + 3 * MILLISECOND);
  event_loop.run();
  for (std::size_t i = 0; i < rung.size(); ++i) {
    const Time due = start + static_cast<Time>(3 + 2 * i) * MILLISECOND;
    require(rung[i] >= due, "an timer does not ring early");
  }
}

void what_can_wait_waits_but_not_for_ever()
{
  EventLoop event_loop;
  const Time start = steady_now();
  Time rung = 0;
  OneShotTimer timer(
    event_loop, Clock(), [&] {
      rung = steady_now();
      event_loop.end();
    },
    [] {return MILLISECOND;});
  timer.schedule(start);
  event_loop.run();
  require(rung - start >= 50 * MILLISECOND, "it is put off for as long as it has to be");
}

void an_alarm_of_another_clock_is_looked_at_when_something_comes()
{
  EventLoop event_loop;
  Time simulated = 0;
  const std::size_t tick = event_loop.add_source([&] {simulated += 10;}, 10);
  OneShotTimer timer(event_loop, {[&] {return simulated;}, false}, [&] {event_loop.end();});
  timer.schedule(30);
  event_loop.notify(tick, 3);
  event_loop.run();
  require(simulated == 30, "it rings at its own clock's time");
}

void what_comes_from_another_thread_wakes_it()
{
  EventLoop event_loop;
  int left = 1000;
  const std::size_t source = event_loop.add_source(
    [&] {
      if (--left == 0) {
        event_loop.end();
      }
    }, 1000);
  std::thread other([&] {
      for (int i = 0; i < 1000; ++i) {
        event_loop.notify(source);
      }
    });
  event_loop.run();
  other.join();
  require(left == 0, "nothing is lost");
}

void a_worker_tells_what_ended_it()
{
  EventLoop event_loop;
  const std::size_t source = event_loop.add_source([] {throw std::runtime_error("broken");}, 1);
  bool is_told = false;
  Worker worker(event_loop, [&](const char *) {is_told = true;});
  worker.start();
  event_loop.notify(source);
  worker.stop();
  require(worker.failure() != nullptr || !is_told, "a failure is kept");
}

}  // namespace

int main()
{
  what_comes_is_done_in_its_order();
  a_flood_starves_no_alarm();
  an_alarm_is_never_early_and_repeats();
  what_can_wait_waits_but_not_for_ever();
  an_alarm_of_another_clock_is_looked_at_when_something_comes();
  what_comes_from_another_thread_wakes_it();
  a_worker_tells_what_ended_it();
  std::puts("all is so");
  return 0;
}
