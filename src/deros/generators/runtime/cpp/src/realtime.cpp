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

/// Change all threads there are; those started later inherit it. Return the error, or 0.
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
      return errno;  // a thread that has ended meanwhile needs no priority
    }
  }
  return error.value();
}

/// Tell whether locked memory can grow: a limit would fail later what is asked for then.
bool may_lock_all()
{
  rlimit limit{};
  return ::geteuid() == 0 ||
         (::getrlimit(RLIMIT_MEMLOCK, &limit) == 0 && limit.rlim_cur == RLIM_INFINITY);
}

}  // namespace

void sharpen_timers()
{
  ::prctl(PR_SET_TIMERSLACK, 1UL, 0UL, 0UL, 0UL);
}

void never_wait_for_readers()
{
  ::signal(SIGPIPE, SIG_IGN);
  for (const int number : {STDOUT_FILENO, STDERR_FILENO}) {
    struct stat found{};
    if (::fstat(number, &found) != 0 || !S_ISFIFO(found.st_mode)) {
      continue;
    }
    const std::string path = "/proc/self/fd/" + std::to_string(number);
    const Descriptor opened(::open(path.c_str(), O_WRONLY | O_NONBLOCK | O_CLOEXEC));
    if (opened) {  // else it is of another user, and stays as it is
      ::dup2(opened.get(), number);
    }
  }
}

std::vector<std::string> prepare(std::int64_t priority, bool lock_memory)
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
    if (!may_lock_all()) {
      refusals.push_back("lock_memory is not permitted: it needs an unlimited RLIMIT_MEMLOCK");
    } else if (::mlockall(MCL_CURRENT | MCL_FUTURE) != 0) {
      refusals.push_back("lock_memory is not permitted: " + error_text(errno));
    }
  }
  return refusals;
}

}  // namespace deros_runtime_cpp
