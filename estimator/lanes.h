#pragma once

#include <array>
#include <cstddef>
#include <cstring>

namespace saccade {

/// Samples that a loop works on together. Arrays of them are padded to whole lanes.
inline constexpr std::size_t kLanes = 16;

[[nodiscard]] constexpr std::size_t padded_to_lanes(std::size_t count) {
  return (count + kLanes - 1) / kLanes * kLanes;
}

/// Partial sums, one for each lane: vector code without reassociation by the compiler.
using LaneSums = std::array<float, kLanes>;

/// Their sum, in a fixed order.
[[nodiscard]] inline double total(LaneSums sums) {
  for (std::size_t width = sums.size() / 2; width > 0; width /= 2)
    for (std::size_t lane = 0; lane < width; ++lane) sums[lane] += sums[lane + width];
  return static_cast<double>(sums[0]);
}

/// Samples in registers; the compiler splits them where registers are shorter.
using Lanes = float __attribute__((vector_size(kLanes * sizeof(float))));

/// `floats` has whole lanes from there on.
[[nodiscard]] inline Lanes load_lanes(const float* floats) {
  Lanes lanes;
  std::memcpy(&lanes, floats, sizeof lanes);
  return lanes;
}

[[nodiscard]] inline double total(const Lanes& lanes) {
  LaneSums sums;
  std::memcpy(sums.data(), &lanes, sizeof sums);
  return total(sums);
}

/// Of double precision there are half as many.
inline constexpr std::size_t kDoubleLanes = kLanes / 2;
using DoubleLanes = double __attribute__((vector_size(kDoubleLanes * sizeof(double))));

[[nodiscard]] inline double total(const DoubleLanes& lanes) {
  double sum = 0;
  for (std::size_t lane = 0; lane < kDoubleLanes; ++lane) sum += lanes[lane];
  return sum;
}

/// Dot product of whole lanes: `count` is a multiple of kLanes.
[[nodiscard]] inline double dot(const float* a, const float* b, std::size_t count) {
  LaneSums sums{};
  for (std::size_t i = 0; i < count; i += kLanes)
    for (std::size_t lane = 0; lane < kLanes; ++lane) sums[lane] += a[i + lane] * b[i + lane];
  return total(sums);
}

}  // namespace saccade
