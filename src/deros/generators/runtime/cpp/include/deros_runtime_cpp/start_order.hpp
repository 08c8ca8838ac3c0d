// Copyright and licence: see package.xml.

/// \file
/// Which of two nodes of one name ends: the one that started last.

#ifndef DEROS_RUNTIME_CPP__START_ORDER_HPP_
#define DEROS_RUNTIME_CPP__START_ORDER_HPP_

#include <optional>

#include "deros_runtime_cpp/event_loop.hpp"

namespace deros_runtime_cpp
{

/// Decides whether a node gives way to another one of its name.
/**
 * The two find each other at about the same moment, and neither knows when the other one started.
 * So each waits for as long again as it has run until then: the one that started last ends first,
 * and the other one finds itself alone.
 */
class StartOrder
{
public:
  /// In ns; a node that meets the other one later than this after its start stays.
  static constexpr Time YOUNG = 5'000'000'000;

  explicit StartOrder(Time now);

  /// Return whether the node is to end, given whether there is another one now.
  bool gives_way(bool has_double, Time now);

private:
  Time started_;
  std::optional<Time> met_;
};

}  // namespace deros_runtime_cpp

#endif  // DEROS_RUNTIME_CPP__START_ORDER_HPP_
