// Copyright and licence: see package.xml.

#include "deros_runtime_cpp/start_order.hpp"

namespace deros_runtime_cpp
{

namespace
{

// In ns; the other one has to be present for this long, as it may be ending.
constexpr Time MIN_PRESENCE = 200'000'000;

}  // namespace

StartOrder::StartOrder(Time now)
: started_(now)
{
}

bool StartOrder::gives_way(bool has_double, Time now)
{
  if (!has_double) {
    met_.reset();
    return false;
  }
  if (!met_) {
    met_ = now;
  }
  const Time age = *met_ - started_;
  return age < YOUNG && now - *met_ >= MIN_PRESENCE + age;
}

}  // namespace deros_runtime_cpp
