// The agenda: what comes is done in order, alarms ring at their time, and nothing is lost.

#include <cstddef>
#include <cstdio>
#include <cstdlib>
#include <stdexcept>
#include <thread>
#include <vector>

#include "tested/runtime/agenda.hpp"
#include "tested/runtime/worker.hpp"

namespace
{

using tested::runtime::Agenda;
using tested::runtime::Alarm;
using tested::runtime::Clock;
using tested::runtime::Time;
using tested::runtime::Worker;
using tested::runtime::steady_now;

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
  Agenda agenda;
  std::vector<int> done;
  const std::size_t first = agenda.add_source([&] {done.push_back(1);}, 2);
  const std::size_t second = agenda.add_source([&] {done.push_back(2);}, 10);
  const std::size_t last = agenda.add_source([&] {agenda.end();}, 1);
  agenda.notify(second);
  agenda.notify(first, 5);  // of which two have room
  agenda.notify(second, 2);
  agenda.notify(last);
  agenda.run();
  require(done == std::vector<int>({2, 1, 1, 2, 2}), "the order of what came");
}

void a_flood_starves_no_alarm()
{
  Agenda agenda;
  std::size_t flood = 0;
  flood = agenda.add_source([&] {agenda.notify(flood);}, 1);
  Alarm alarm(agenda, Clock(), [&] {agenda.end();});
  alarm.ring_at(steady_now() + 5 * MILLISECOND);
  agenda.notify(flood);
  agenda.run();
}

void an_alarm_is_never_early_and_repeats()
{
  Agenda agenda;
  const Time start = steady_now();
  std::vector<Time> rung;
  Alarm alarm(
    agenda, Clock(), [&] {
      rung.push_back(steady_now());
      if (rung.size() == 3) {
        agenda.end();
      }
      alarm.repeat(2 * MILLISECOND);
    });
  alarm.ring_at(start + 3 * MILLISECOND);
  agenda.run();
  for (std::size_t i = 0; i < rung.size(); ++i) {
    const Time due = start + static_cast<Time>(3 + 2 * i) * MILLISECOND;
    require(rung[i] >= due, "an alarm does not ring early");
  }
}

void what_can_wait_waits_but_not_for_ever()
{
  Agenda agenda;
  const Time start = steady_now();
  Time rung = 0;
  Alarm alarm(
    agenda, Clock(), [&] {
      rung = steady_now();
      agenda.end();
    },
    [] {return MILLISECOND;});
  alarm.ring_at(start);
  agenda.run();
  require(rung - start >= 50 * MILLISECOND, "it is put off for as long as it has to be");
}

void an_alarm_of_another_clock_is_looked_at_when_something_comes()
{
  Agenda agenda;
  Time simulated = 0;
  const std::size_t tick = agenda.add_source([&] {simulated += 10;}, 10);
  Alarm alarm(agenda, {[&] {return simulated;}, false}, [&] {agenda.end();});
  alarm.ring_at(30);
  agenda.notify(tick, 3);
  agenda.run();
  require(simulated == 30, "it rings at its own clock's time");
}

void what_comes_from_another_thread_wakes_it()
{
  Agenda agenda;
  int left = 1000;
  const std::size_t source = agenda.add_source(
    [&] {
      if (--left == 0) {
        agenda.end();
      }
    }, 1000);
  std::thread other([&] {
      for (int i = 0; i < 1000; ++i) {
        agenda.notify(source);
      }
    });
  agenda.run();
  other.join();
  require(left == 0, "nothing is lost");
}

void a_worker_tells_what_ended_it()
{
  Agenda agenda;
  const std::size_t source = agenda.add_source([] {throw std::runtime_error("broken");}, 1);
  bool is_told = false;
  Worker worker(agenda, [&](const char *) {is_told = true;});
  worker.start();
  agenda.notify(source);
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
