#pragma once

#include <cstdint>

namespace saccade {

/// The upper four bits of a word of EVT 2.0, and of the half without the mask of EVT 2.1.
enum class Evt2Type : unsigned {
  kOff = 0x0,
  kOn = 0x1,
  kTimeHigh = 0x8,
  kTrigger = 0xA,
  kOthers = 0xE,
  kContinued = 0xF,
};

[[nodiscard]] constexpr bool is_evt2_type(std::uint32_t bits) {
  return bits <= 0x1 || bits == 0x8 || bits == 0xA || bits >= 0xE;
}

/// How many values the upper bits of the time have.
constexpr std::int64_t kEvt2Highs = std::int64_t{1} << 28U;
constexpr std::uint32_t kEvt2HighMask = 0xFFFFFFF;

}  // namespace saccade
