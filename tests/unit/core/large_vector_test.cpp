#include "core/large_vector.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <utility>

namespace saccade {
namespace {

TEST(LargeVector, KeepsItsItemsFromSmallToLarge) {
  LargeVector<double> items;
  constexpr std::size_t kCount = std::size_t{3} << 20U;  // 24 MiB
  for (std::size_t i = 0; i < kCount; ++i) items.push_back(static_cast<double>(i));
  for (std::size_t i = 0; i < kCount; i += 4097) ASSERT_EQ(items[i], static_cast<double>(i));
  const LargeVector<double> copy = items;
  const LargeVector<double> moved = std::move(items);
  EXPECT_EQ(copy, moved);
}

TEST(LargeVector, ItsMemoryIsAligned) {
  struct alignas(64) Line {
    double values[8] = {};
  };
  const LargeVector<Line> few(3);
  const LargeVector<Line> many(std::size_t{1} << 18U);
  EXPECT_EQ(reinterpret_cast<std::uintptr_t>(few.data()) % 64, 0U);
  EXPECT_EQ(reinterpret_cast<std::uintptr_t>(many.data()) % 64, 0U);
}

}  // namespace
}  // namespace saccade
