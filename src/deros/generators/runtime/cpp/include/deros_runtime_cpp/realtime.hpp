// Copyright and licence: see package.xml.

#ifndef DEROS_RUNTIME_CPP__REALTIME_HPP_
#define DEROS_RUNTIME_CPP__REALTIME_HPP_

#include <cstdint>
#include <string>
#include <vector>

namespace deros_runtime_cpp
{

/// Have the kernel wake this thread, and those it starts, without the usual 50 us of slack.
void sharpen_timers();

/// Lose what is written to a full or broken pipe, rather than wait until somebody reads it.
/**
 * A launcher that hangs would hang the node, too, and one that ends would end it. The pipes are
 * opened anew, because the flag would else hold for all who share them.
 */
void never_wait_for_readers();

/// Set the process up as its parameters say; return what was not permitted, each in words.
/**
 * A priority above 0 puts all threads there are, and those that they start, under the scheduling
 * policy SCHED_FIFO. Locked memory is never paged out.
 */
std::vector<std::string> prepare(std::int64_t priority, bool lock_memory);

}  // namespace deros_runtime_cpp

#endif  // DEROS_RUNTIME_CPP__REALTIME_HPP_
