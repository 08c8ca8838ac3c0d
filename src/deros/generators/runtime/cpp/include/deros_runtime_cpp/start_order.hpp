// Copyright and licence: see package.xml.

/// \file
/// Which of two nodes with the same name ends: the one that started last.

#ifndef DEROS_RUNTIME_CPP__START_ORDER_HPP_
#define DEROS_RUNTIME_CPP__START_ORDER_HPP_

#include <optional>

#include "deros_runtime_cpp/event_loop.hpp"

namespace deros_runtime_cpp
{

/// Decides whether a node ends because another one has the same name.
/**
 * The two discover each other at about the same time, and neither knows when the other started. So
 * each waits for as long as it has been running: the one that started last ends first, and then the
 * other one is alone.
 */
class StartOrder
{
public:
  /// In ns; a node that discovers another one later than this after its start stays.
  static constexpr Time YOUNG = 5'000'000'000;

  explicit StartOrder(Time now);

  /// Return whether the node has to end, given whether there is another one now.
  bool gives_way(bool has_double, Time now);

private:
  Time started_;
  std::optional<Time> met_;
};

}  // namespace deros_runtime_cpp

#endif  // DEROS_RUNTIME_CPP__START_ORDER_HPP_
