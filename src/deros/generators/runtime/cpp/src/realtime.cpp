// Copyright and licence: see package.xml.

#include "deros_runtime_cpp/realtime.hpp"

#include <fcntl.h>
#include <sched.h>
#include <signal.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdint>
#include <filesystem>
#include <string>
#include <system_error>
#include <vector>

#include "deros_runtime_cpp/descriptor.hpp"
#include "deros_runtime_cpp/text.hpp"

namespace deros_runtime_cpp
{

namespace
{

/// Set the priority of all threads; later ones inherit it. Return the error number, or 0.
int raise_priority(int priority)
{
  sched_param settings{};
  settings.sched_priority = priority;
  std::error_code error;
  for (std::filesystem::directory_iterator task("/proc/self/task", error), end;
    !error && task != end; task.increment(error))
  {
    const pid_t thread = std::stoi(task->path().filename().string());
    if (::sched_setscheduler(thread, SCHED_FIFO, &settings) != 0 && errno != ESRCH) {
      return errno;  // a thread that has ended in the meantime is not an error
    }
  }
  return error.value();
}

/// Return whether locked memory can grow: with a limit, later allocations would fail.
bool can_lock_memory()
{
  rlimit limit{};
  return ::geteuid() == 0 ||
         (::getrlimit(RLIMIT_MEMLOCK, &limit) == 0 && limit.rlim_cur == RLIM_INFINITY);
}

}  // namespace

void minimize_timer_slack()
{
  ::prctl(PR_SET_TIMERSLACK, 1UL, 0UL, 0UL, 0UL);
}

void make_output_nonblocking()
{
  ::signal(SIGPIPE, SIG_IGN);
  for (const int number : {STDOUT_FILENO, STDERR_FILENO}) {
    struct stat found{};
    if (::fstat(number, &found) != 0 || !S_ISFIFO(found.st_mode)) {
      continue;
    }
    const std::string path = "/proc/self/fd/" + std::to_string(number);
    const Descriptor opened(::open(path.c_str(), O_WRONLY | O_NONBLOCK | O_CLOEXEC));
    if (opened) {  // otherwise it belongs to another user, and is not changed
      ::dup2(opened.get(), number);
    }
  }
}

std::vector<std::string> configure_process(std::int64_t priority, bool lock_memory)
{
  std::vector<std::string> refusals;
  if (priority > 0) {
    const int error = raise_priority(static_cast<int>(priority));
    if (error != 0) {
      refusals.push_back(
        "realtime_priority " + std::to_string(priority) + " is not permitted: " +
        error_text(error));
    }
  }
  if (lock_memory) {
    if (!can_lock_memory()) {
      refusals.push_back("lock_memory is not permitted: it needs an unlimited RLIMIT_MEMLOCK");
    } else if (::mlockall(MCL_CURRENT | MCL_FUTURE) != 0) {
      refusals.push_back("lock_memory is not permitted: " + error_text(errno));
    }
  }
  return refusals;
}

}  // namespace deros_runtime_cpp
