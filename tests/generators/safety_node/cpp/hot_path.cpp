// A node without ROS: it gets messages from another thread, and must not allocate any memory.

#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <limits>
#include <new>
#include <vector>

#include "every_thing_safety_cpp/runtime/event_loop.hpp"
#include "every_thing_safety_cpp/runtime/monitor_runner.hpp"
#include "every_thing_safety_node_messages.hpp"
#include "every_thing_safety_node_rule_metadata.hpp"

namespace runtime = every_thing_safety_cpp::runtime;

namespace
{

bool counts = false;
std::size_t allocations = 0;

}  // namespace

void * operator new(std::size_t size)
{
  allocations += counts ? 1 : 0;
  void * memory = std::malloc(size);
  if (memory == nullptr) {
    throw std::bad_alloc();
  }
  return memory;
}

void operator delete(void * memory) noexcept
{
  std::free(memory);
}

void operator delete(void * memory, std::size_t /*size*/) noexcept
{
  std::free(memory);
}

namespace
{

class Node : public runtime::MonitorHost
{
public:
  Node()
  : runner_(event_loop_, runtime::Clock(), *this),
    active_(every_thing_safety_cpp::rule_metadata().actions.size()),
    speeds_(event_loop_.add_source([this] {take_speed();}, 10)),
    repeats_(event_loop_, runtime::Clock(), [this] {repeat();})
  {
  }

  void run()
  {
    runner_.start();
    event_loop_.notify(speeds_);
    repeats_.schedule(runtime::steady_now());
    event_loop_.run();
  }

  void begin(runtime::Time start) override
  {
    every_thing_start(&monitor_, this, start, 0);
  }

  void advance(runtime::Time now) override
  {
    every_thing_advance(&monitor_, now);
  }

  runtime::Time next_deadline() const override
  {
    return monitor_.due;
  }

  bool show(const runtime::Event & event) override
  {
    active_[EVERY_THING_ACTION_STOP] = event.kind == runtime::EventKind::Trigger;
    every_thing_safety_cpp::show_stop(state_, active_);
    shown_ += state_.data ? 1 : 0;
    return event.site % 2 == 0;  // the others act like user code
  }

  void run_code(const runtime::Event & /*event*/) override
  {
    ++acted_;
  }

  void save_snapshot(std::size_t /*count*/) override {}

  void after(
    const std::vector<runtime::Event> & /*events*/,
    const std::vector<runtime::Time> & /*done*/) override
  {
  }

  void flush_reports() override {}
  void report_failure(const runtime::Event & /*event*/, const char * /*why*/) override {}
  void clock_stepped() override {}

  void take(const runtime::Event & event)
  {
    runner_.take(event);
  }

  std::size_t shown() const
  {
    return shown_;
  }

  std::size_t acted() const
  {
    return acted_;
  }

private:
  void take_speed()
  {
    // The simulated clock advances by 60 ms per message, so that every 'for' elapses.
    now_ += 60'000'000;
    speed_.data = taken_ % 8 < 4 ? 0.9 : 0.1;
    runner_.catch_up();
    every_thing_safety_cpp::take_speed(monitor_, now_, speed_);
    runner_.settle();
    ++taken_;
    counts = taken_ > 100;
    if (taken_ == 2000) {
      counts = false;
      event_loop_.stop();
      return;
    }
    event_loop_.notify(speeds_);
  }

  void repeat()
  {
    every_thing_safety_cpp::show_stop(state_, active_);
    repeats_.repeat(100'000);
  }

  runtime::EventLoop event_loop_;
  runtime::MonitorRunner runner_;
  every_thing_monitor monitor_;
  std::vector<bool> active_;
  std_msgs::msg::Bool state_;
  std_msgs::msg::Float64 speed_;
  std::size_t speeds_;
  runtime::OneShotTimer repeats_;
  runtime::Time now_ = runtime::steady_now();
  std::size_t taken_ = 0;
  std::size_t shown_ = 0;
  std::size_t acted_ = 0;
};

}  // namespace

void every_thing_emit(void * owner, int64_t t, every_thing_kind kind, uint32_t site)
{
  static_cast<Node *>(owner)->take({t, static_cast<runtime::EventKind>(kind), site});
}

int main()
{
  Node node;
  node.run();
  const bool has_acted = node.shown() > 100 && node.acted() > 100;
  std::printf("%s, %zu allocations\n", has_acted ? "acted" : "idle", allocations);
  return 0;
}
