// Copyright and licence: see package.xml.

#ifndef DEROS_RUNTIME_CPP__REFUSAL_HPP_
#define DEROS_RUNTIME_CPP__REFUSAL_HPP_

#include <stdexcept>

namespace deros_runtime_cpp
{

/// The node must not run, for the reason in the text. It is not an error of the program.
class Refusal : public std::runtime_error
{
public:
  using std::runtime_error::runtime_error;
};

}  // namespace deros_runtime_cpp

#endif  // DEROS_RUNTIME_CPP__REFUSAL_HPP_
