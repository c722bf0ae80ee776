#include <bit>
#include <limits>

#include "core/io/events/prophesee/evt2.h"
#include "core/io/events/prophesee/evt2_words.h"
#include "core/io/events/prophesee/raw_reader.h"

namespace saccade {
namespace {

/// What the words of EVT 2.0 and 2.1 have in common.
class Evt2State {
 public:
  Evt2State(const RawHeader& header, RawLimits limits)
      : limits_(limits), origin_us_(header.origin_us) {}

  void set_high(std::uint32_t word) {
    const std::int64_t high = word & kEvt2HighMask;
    // Backwards by more than half of the range is a wrap.
    const bool is_wrap = has_time_ && high + (kEvt2Highs / 2) < high_;
    if (is_wrap && wraps_ < kMostTime_us >> 6U) wraps_ += kEvt2Highs;
    high_ = high;
    has_time_ = true;
    block_ns_ = (origin_us_ + ((wraps_ + high_) << 6U)) * 1000;
  }
  [[nodiscard]] bool has_time() const { return has_time_; }

  /// The event of a word, whose column may be less than that of the last one in its mask.
  [[nodiscard]] Event event(std::uint32_t word, unsigned columns, std::size_t index) {
    const unsigned x = (word >> 11U) & 0x7FFU;
    const unsigned y = word & 0x7FFU;
    const TimeNs t_ns = block_ns_ + static_cast<TimeNs>((word >> 22U) & 0x3FU) * 1000;
    const unsigned last_x = x + columns - 1;
    if (last_x >= limits_.width || y >= limits_.height || t_ns < last_ns_) [[unlikely]]
      refuse(last_x, y, t_ns, index);
    last_ns_ = t_ns;
    return {
        t_ns, static_cast<std::uint16_t>(x), static_cast<std::uint16_t>(y),
        static_cast<std::int8_t>((word >> 28U) == static_cast<unsigned>(Evt2Type::kOn) ? 1 : -1)};
  }

 private:
  [[noreturn]] void refuse(unsigned x, unsigned y, TimeNs t_ns, std::size_t index) const {
    if (x >= limits_.width || y >= limits_.height)
      throw RawError{index, outside_sensor(x, y, limits_)};
    throw RawError{index, time_goes_back(t_ns, last_ns_)};
  }

  RawLimits limits_;
  std::int64_t origin_us_;
  std::int64_t wraps_ = 0;
  std::int64_t high_ = 0;
  bool has_time_ = false;
  TimeNs block_ns_ = 0;  ///< time of the upper bits
  TimeNs last_ns_ = std::numeric_limits<TimeNs>::min();
};

/// Whether a word carries an event; takes the time from those that carry that.
bool is_event(std::uint32_t word, std::size_t index, Evt2State& state) {
  switch (static_cast<Evt2Type>(word >> 28U)) {
    case Evt2Type::kOff:
    case Evt2Type::kOn:
      return state.has_time();
    case Evt2Type::kTimeHigh:
      state.set_high(word);
      return false;
    case Evt2Type::kTrigger:
    case Evt2Type::kOthers:
    case Evt2Type::kContinued:
      return false;
    default:
      throw RawError{index, fmt::format("word {:08x} is of a type that EVT2 does not have; the "
                                        "data are damaged or of another encoding",
                                        word)};
  }
}

class Evt2Decoder {
 public:
  using Word = std::uint32_t;
  static constexpr std::size_t kMostEvents = 1;

  Evt2Decoder(const RawHeader& header, RawLimits limits, std::span<const std::byte> /*first*/)
      : state_(header, limits) {}

  Event* decode(const std::byte* words, std::size_t count, Event* out) {
    for (std::size_t i = 0; i < count; ++i) {
      const auto word = load<Word>(words + i * sizeof(Word));
      if (is_event(word, i, state_)) *out++ = state_.event(word, 1, i);
    }
    return out;
  }

 private:
  Evt2State state_;
};

/// Whether the half with the mask comes last. Only the other has a type in its upper bits, so that
/// more of the first words are valid in the right order.
bool is_mask_last(const RawHeader& header, std::span<const std::byte> first) {
  if (header.endianness == "little") return false;
  if (header.endianness == "legacy") return true;
  constexpr std::size_t kWords = 64;
  int balance = 0;
  for (std::size_t i = 0; i < std::min(first.size() / 8, kWords); ++i) {
    balance += is_evt2_type(load<std::uint32_t>(first.data() + 8 * i) >> 28U) ? 1 : 0;
    balance -= is_evt2_type(load<std::uint32_t>(first.data() + 8 * i + 4) >> 28U) ? 1 : 0;
  }
  return balance >= 0;
}

class Evt21Decoder {
 public:
  using Word = std::uint64_t;
  static constexpr std::size_t kMostEvents = 32;

  Evt21Decoder(const RawHeader& header, RawLimits limits, std::span<const std::byte> first)
      : state_(header, limits), is_mask_last_(is_mask_last(header, first)) {}

  Event* decode(const std::byte* words, std::size_t count, Event* out) {
    for (std::size_t i = 0; i < count; ++i) {
      const auto lower = load<std::uint32_t>(words + i * sizeof(Word));
      const auto upper = load<std::uint32_t>(words + i * sizeof(Word) + sizeof lower);
      const std::uint32_t word = is_mask_last_ ? lower : upper;
      std::uint32_t mask = is_mask_last_ ? upper : lower;
      if (!is_event(word, i, state_) || mask == 0) continue;
      const Event first = state_.event(word, static_cast<unsigned>(std::bit_width(mask)), i);
      for (; mask != 0; mask &= mask - 1) {
        *out = first;
        out++->x = static_cast<std::uint16_t>(first.x + std::countr_zero(mask));
      }
    }
    return out;
  }

 private:
  Evt2State state_;
  bool is_mask_last_;
};

}  // namespace

std::unique_ptr<EventReader> open_evt2(const std::filesystem::path& file, SensorSize size,
                                       TimeWindow window) {
  return std::make_unique<RawEventReader<Evt2Decoder>>(file, size, window);
}

std::unique_ptr<EventReader> open_evt21(const std::filesystem::path& file, SensorSize size,
                                        TimeWindow window) {
  return std::make_unique<RawEventReader<Evt21Decoder>>(file, size, window);
}

}  // namespace saccade
