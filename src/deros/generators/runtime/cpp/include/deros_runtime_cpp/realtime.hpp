// Copyright and licence: see package.xml.

#ifndef DEROS_RUNTIME_CPP__REALTIME_HPP_
#define DEROS_RUNTIME_CPP__REALTIME_HPP_

#include <cstdint>
#include <string>
#include <vector>

namespace deros_runtime_cpp
{

/// Set the timer slack of this thread, and of those that it starts, from 50 us to the minimum.
void minimize_timer_slack();

/// Discard output to a full or broken pipe instead of blocking.
/**
 * Otherwise a launcher that hangs would block the node, and one that ends would end it. The pipes
 * are opened again, because the flag would also apply to the processes that share them.
 */
void make_output_nonblocking();

/// Set the scheduling and the memory of the process; return what was not permitted, in words.
/**
 * A priority above 0 puts all threads, and those that they start, under the scheduling policy
 * SCHED_FIFO. Locked memory is never paged out.
 */
std::vector<std::string> configure_process(std::int64_t priority, bool lock_memory);

}  // namespace deros_runtime_cpp

#endif  // DEROS_RUNTIME_CPP__REALTIME_HPP_
