#pragma once

#include <cstdint>

namespace saccade {

/// Greatest rate of a noise process of one pixel that a configuration may ask for [1/s].
constexpr double kMaxNoiseRate_hz = 1e5;

/// Who draws random numbers at a pixel. Apart, so that switching one model on changes no draw of
/// another.
enum class NoiseStream : std::uint64_t {
  kMismatch = 1,
  kLeak = 2,
  kShot = 3,
  kHotPixel = 4,  ///< which pixels are hot, and how much
  kHotEvents = 5,
  kLatency = 6,
};

/// The stream of `core/random.h` for a model at a pixel.
[[nodiscard]] constexpr std::uint64_t noise_stream(NoiseStream stream, std::uint16_t x,
                                                   std::uint16_t y) {
  return (static_cast<std::uint64_t>(stream) << 32) | (std::uint64_t{y} << 16) | x;
}

}  // namespace saccade
