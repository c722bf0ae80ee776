#pragma once

#include <sys/mman.h>

#include <cstddef>
#include <cstdlib>
#include <memory>
#include <new>
#include <vector>

namespace saccade {

/// Asks for pages of 2 MiB for allocations of several of them. A page that is touched for the first
/// time costs a microsecond whatever its size, as much as it takes to fill a small one.
template <class T>
struct LargePageAllocator {
  using value_type = T;

  LargePageAllocator() = default;
  template <class Other>
  explicit(false) LargePageAllocator(const LargePageAllocator<Other>& /*other*/) noexcept {}

  [[nodiscard]] T* allocate(std::size_t count) {
    const std::size_t size = count * sizeof(T);
    if (size < kLeastSize) return std::allocator<T>().allocate(count);
    void* memory = std::aligned_alloc(kPageSize, (size + kPageSize - 1) / kPageSize * kPageSize);
    if (memory == nullptr) throw std::bad_alloc();
    // A wish: without it everything is as it was, only slower.
    static_cast<void>(madvise(memory, size, MADV_HUGEPAGE));
    return static_cast<T*>(memory);
  }
  void deallocate(T* memory, std::size_t count) noexcept {
    if (count * sizeof(T) < kLeastSize)
      std::allocator<T>().deallocate(memory, count);
    else
      std::free(memory);
  }
  friend bool operator==(const LargePageAllocator& /*a*/, const LargePageAllocator& /*b*/) {
    return true;
  }

 private:
  static constexpr std::size_t kPageSize = std::size_t{2} << 20U;
  static constexpr std::size_t kLeastSize = 4 * kPageSize;
};

/// For tables of a scene's triangles.
template <class T>
using LargeVector = std::vector<T, LargePageAllocator<T>>;

}  // namespace saccade
