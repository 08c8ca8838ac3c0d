// Copies arrays of flags, and counts the allocations; exit code 1: not as it should be.

#include <array>
#include <cstddef>
#include <cstdlib>
#include <new>
#include <vector>

#include "deros_runtime_cpp/flags.hpp"

namespace
{

int allocations = 0;

template<typename Array>
bool same(const bool * entries, const Array & array)
{
  for (std::size_t i = 0; i < array.size(); ++i) {
    if (entries[i] != array[i]) {
      return false;
    }
  }
  return true;
}

}  // namespace

void * operator new[](std::size_t size)
{
  ++allocations;
  void * const memory = std::malloc(size);
  if (memory == nullptr) {
    throw std::bad_alloc();
  }
  return memory;
}

void operator delete[](void * memory) noexcept
{
  std::free(memory);
}

void operator delete[](void * memory, std::size_t /*size*/) noexcept
{
  std::free(memory);
}

int main()
{
  using deros_runtime_cpp::flags;
  const std::vector<bool> valid{true, false, true}, clear{false, false, true};
  const bool * const first = flags<0>(valid);
  const bool * const second = flags<1>(clear);
  bool good = first != second && same(first, valid) && same(second, clear);
  const int before = allocations;
  const std::vector<bool> shorter{false, true};
  good = good && flags<0>(shorter) == first && same(first, shorter) && allocations == before;
  flags<0>(std::vector<bool>{});
  const std::vector<bool> longer(100, true);
  good = good && same(flags<0>(longer), longer) && allocations == before + 1;
  return good ? 0 : 1;
}
