#ifndef DEROS_RUNTIME__RUNTIME__REFUSAL_HPP_
#define DEROS_RUNTIME__RUNTIME__REFUSAL_HPP_

#include <stdexcept>

namespace deros_runtime
{

/// The node must not run; the text says why. It is no error of the program.
class Refusal : public std::runtime_error
{
public:
  using std::runtime_error::runtime_error;
};

}  // namespace deros_runtime

#endif  // DEROS_RUNTIME__RUNTIME__REFUSAL_HPP_
