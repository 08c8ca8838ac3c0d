// Copyright and licence: see package.xml.

#ifndef DEROS_RUNTIME_CPP__DESCRIPTOR_HPP_
#define DEROS_RUNTIME_CPP__DESCRIPTOR_HPP_

#include <unistd.h>

#include <utility>

namespace deros_runtime_cpp
{

/// A file descriptor, which is closed by the destructor.
class Descriptor
{
public:
  Descriptor() = default;
  explicit Descriptor(int number)
  : number_(number)
  {
  }
  ~Descriptor()
  {
    close();
  }
  Descriptor(const Descriptor &) = delete;
  Descriptor & operator=(const Descriptor &) = delete;
  Descriptor(Descriptor && other) noexcept
  : number_(std::exchange(other.number_, -1))
  {
  }
  Descriptor & operator=(Descriptor && other) noexcept
  {
    if (this != &other) {
      close();
      number_ = std::exchange(other.number_, -1);
    }
    return *this;
  }

  /// Return its number; negative if it is not open.
  int get() const
  {
    return number_;
  }

  /// Return whether it is open.
  explicit operator bool() const
  {
    return number_ >= 0;
  }

private:
  void close() noexcept
  {
    if (number_ >= 0) {
      ::close(number_);
    }
  }

  int number_ = -1;
};

}  // namespace deros_runtime_cpp

#endif  // DEROS_RUNTIME_CPP__DESCRIPTOR_HPP_
