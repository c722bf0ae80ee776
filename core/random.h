#pragma once

#include <array>
#include <cstdint>

namespace saccade {

/// Counter-based random numbers (Philox 4x32-10; Salmon et al., SC 2011): a pure function of
/// (seed, stream, index), so a draw never depends on the order or the thread in which others are
/// made. `stream` names who draws (a pixel, a point set), `index` which of its draws this is.
class Random {
 public:
  explicit Random(std::uint64_t seed) : seed_(seed) {}

  /// 128 random bits.
  [[nodiscard]] std::array<std::uint32_t, 4> bits(std::uint64_t stream, std::uint64_t index) const;

  /// Uniform in [0, 1), 53 bits.
  [[nodiscard]] double uniform(std::uint64_t stream, std::uint64_t index) const;

  /// Standard normal (Box-Muller on one draw).
  [[nodiscard]] double normal(std::uint64_t stream, std::uint64_t index) const;

  /// Uniform integer in [0, bound); bound >= 1. The bias is below bound / 2^64.
  [[nodiscard]] std::uint64_t below(std::uint64_t bound, std::uint64_t stream,
                                    std::uint64_t index) const;

 private:
  std::uint64_t seed_;
};

}  // namespace saccade
