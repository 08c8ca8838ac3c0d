// Copyright and licence: see package.xml.

/// \file
/// Looks ahead: what becomes of the verdicts of rules as time goes on, without news.

#ifndef DEROS_RUNTIME_CPP__LOOK_AHEAD_HPP_
#define DEROS_RUNTIME_CPP__LOOK_AHEAD_HPP_

#include <array>
#include <cstddef>
#include <memory>
#include <vector>

#include "deros_runtime_cpp/event_loop.hpp"
#include "deros_runtime_cpp/report_types.hpp"

namespace deros_runtime_cpp
{

/// A copy of a monitor: nobody acts on what it orders, and it takes no messages.
class MonitorCopy
{
public:
  virtual ~MonitorCopy() = default;

  /// Return when something can happen next; the maximum for never.
  virtual Time next_deadline() const = 0;

  /// Advance up to and including a time.
  virtual void advance(Time time) = 0;

  /// Return the states of the rules.
  virtual MonitorSnapshot snapshot() const = 0;
};

/// A copy of a monitor in C, whose functions are the arguments of the template.
template<
  typename Monitor, Time (*ADVANCE)(Monitor *, Time), MonitorSnapshot (*SNAPSHOT)(const Monitor &)>
class CopyOf : public MonitorCopy
{
public:
  explicit CopyOf(const Monitor & monitor)
  : monitor_(monitor)
  {
    monitor_.owner = nullptr;  // who takes its events leaves those without an owner
  }

  /// Return the copy itself.
  Monitor & monitor()
  {
    return monitor_;
  }

  Time next_deadline() const override
  {
    return monitor_.due;
  }

  void advance(Time time) override
  {
    ADVANCE(&monitor_, time);
  }

  MonitorSnapshot snapshot() const override
  {
    return SNAPSHOT(monitor_);
  }

private:
  Monitor monitor_;
};

/// The copies in which a monitor is played ahead.
struct MonitorCopies
{
  std::unique_ptr<MonitorCopy> staying;  // inputs with a timeout do not go missing
  std::unique_ptr<MonitorCopy> silent;
};

/// What a rule becomes next, and what has to be the case.
struct NextVerdict
{
  const char * condition;
  Verdict verdict;
  Time at;
};

/// Plays the deadlines of a monitor in copies, until all rules have changed or none is left.
class LookAhead
{
public:
  /// Look ahead from the present states of the rules, with copies of this moment.
  LookAhead(const std::vector<RuleState> & rules, MonitorCopies copies);

  /// Look at the next instant; return false if there is none.
  bool step();

  /// Return the next verdicts of each rule that changes, by its place.
  const std::vector<std::vector<NextVerdict>> & found() const
  {
    return found_;
  }

private:
  struct Case
  {
    std::unique_ptr<MonitorCopy> copy;
    const char * condition = "";
    std::vector<bool> is_found = {};
    std::size_t left = 0;  // rules that have not changed
    std::size_t instants = 0;  // that may still be looked at
  };

  bool step(Case & played);

  std::vector<Verdict> before_;
  std::array<Case, 2> cases_;
  std::vector<std::vector<NextVerdict>> found_;
};

}  // namespace deros_runtime_cpp

#endif  // DEROS_RUNTIME_CPP__LOOK_AHEAD_HPP_
