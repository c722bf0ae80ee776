#pragma once

namespace saccade {

/// The upper four bits of a word of EVT 3.0.
enum class Evt3Type : unsigned {
  kAddressY = 0x0,
  kAddressX = 0x2,
  kVectorBaseX = 0x3,
  kVector12 = 0x4,
  kVector8 = 0x5,
  kTimeLow = 0x6,
  kContinued4 = 0x7,
  kTimeHigh = 0x8,
  kTrigger = 0xA,
  kOthers = 0xE,
  kContinued12 = 0xF,
};

/// How many values the upper bits of the time have, and half of them.
constexpr int kEvt3Highs = 4096;
constexpr int kEvt3HalfHigh = kEvt3Highs / 2;

}  // namespace saccade
