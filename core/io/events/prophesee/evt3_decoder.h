#pragma once

#include <fmt/format.h>

#include <bit>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>

#include "core/event.h"
#include "core/io/events/prophesee/evt3_words.h"
#include "core/io/events/prophesee/raw_header.h"
#include "core/io/events/prophesee/raw_reader.h"
#include "core/io/files/byte_reader.h"

namespace saccade {

/// Decodes the words of EVT 3.0 (evt3.h), as a Decoder of RawEventReader: of a file, or of packets
/// that go on where the one before ended.
class Evt3Decoder {
 public:
  using Word = std::uint16_t;
  static constexpr std::size_t kMostEvents = 12;

  Evt3Decoder(const RawHeader& header, RawLimits limits, std::span<const std::byte> /*first*/ = {})
      : limits_(limits), origin_us_(header.origin_us) {}

  Event* decode(const std::byte* words, std::size_t count, Event* out) {
    const Event* timed = out;  // events before it have another time than t_ns_
    for (std::size_t i = 0; i < count; ++i) {
      const auto word = load<Word>(words + i * sizeof(Word));
      const unsigned value = word & 0xFFFU;
      const unsigned position = word & 0x7FFU;
      switch (static_cast<Evt3Type>(word >> 12U)) {
        case Evt3Type::kAddressX:
          if (position >= width_) [[unlikely]]
            if (!accept(position, i)) break;
          *out++ = event(position, polarity(word));
          break;
        case Evt3Type::kAddressY:
          y_ = position;
          update_width();
          break;
        case Evt3Type::kVectorBaseX:
          base_x_ = position;
          vector_polarity_ = polarity(word);
          break;
        case Evt3Type::kVector12:
          out = decode_vector(value, i, out);
          base_x_ += 12;
          break;
        case Evt3Type::kVector8:
          out = decode_vector(value & 0xFFU, i, out);
          base_x_ += 8;
          break;
        case Evt3Type::kTimeLow:
          low_ = value;
          set_time(timed, out);
          break;
        case Evt3Type::kTimeHigh:
          set_high(value);
          set_time(timed, out);
          break;
        case Evt3Type::kContinued4:
        case Evt3Type::kTrigger:
        case Evt3Type::kOthers:
        case Evt3Type::kContinued12:
          break;
        default:
          throw RawError{i, fmt::format("word {:04x} is of a type that EVT3 does not have; the "
                                        "data are damaged or of another encoding",
                                        word)};
      }
    }
    if (out != timed) last_ns_ = t_ns_;
    return out;
  }

 private:
  static std::int8_t polarity(Word word) { return (word & 0x800U) != 0 ? 1 : -1; }

  [[nodiscard]] Event event(unsigned x, std::int8_t polarity) const {
    return {t_ns_, static_cast<std::uint16_t>(x), static_cast<std::uint16_t>(y_), polarity};
  }

  Event* decode_vector(unsigned mask, std::size_t word, Event* out) {
    if (mask == 0) return out;
    if (const unsigned last = base_x_ + static_cast<unsigned>(std::bit_width(mask)) - 1;
        last >= width_) [[unlikely]]
      if (!accept(last, word)) return out;
    for (; mask != 0; mask &= mask - 1)
      *out++ = event(base_x_ + static_cast<unsigned>(std::countr_zero(mask)), vector_polarity_);
    return out;
  }

  void set_high(unsigned high) {
    // Backwards by more than half of the range is a wrap.
    const bool is_wrap = has_time_ && high + kEvt3HalfHigh < high_;
    if (is_wrap && wraps_ < kMostTime_us >> 12U) wraps_ += kEvt3Highs;
    if (!has_time_ || high != high_) low_ = 0;
    high_ = high;
    has_time_ = true;
  }

  /// The time of the events after those up to `out`.
  void set_time(const Event*& timed, const Event* out) {
    if (out != timed) last_ns_ = t_ns_;
    timed = out;
    t_ns_ = (origin_us_ + ((wraps_ + high_) << 12U) + low_) * 1000;
    update_width();
  }

  /// One comparison tells whether an event may be: no column lies below 0 while the row is outside
  /// or the time before that of the last event.
  void update_width() {
    width_ = y_ < limits_.height && t_ns_ >= last_ns_ && has_time_ ? limits_.width : 0;
  }

  /// Why column `x` is refused; false where the event is only to be left out.
  [[nodiscard]] bool accept(unsigned x, std::size_t word) const {
    if (!has_time_) return false;
    if (x >= limits_.width || y_ >= limits_.height)
      throw RawError{word, outside_sensor(x, y_, limits_)};
    throw RawError{word, time_goes_back(t_ns_, last_ns_)};
  }

  RawLimits limits_;
  std::int64_t origin_us_;
  std::int64_t wraps_ = 0;  ///< upper bits that went by in whole ranges
  unsigned high_ = 0;
  unsigned low_ = 0;
  bool has_time_ = false;
  TimeNs t_ns_ = std::numeric_limits<TimeNs>::min();
  TimeNs last_ns_ = std::numeric_limits<TimeNs>::min();  ///< of the last event with another time
  unsigned y_ = 0;
  unsigned width_ = 0;  ///< limits_.width, or 0 where no event may be
  unsigned base_x_ = 0;
  std::int8_t vector_polarity_ = -1;
};

}  // namespace saccade
