#include <limits>

#include "core/io/events/prophesee/evt2.h"
#include "core/io/events/prophesee/raw_reader.h"

namespace saccade {
namespace {

class DatDecoder {
 public:
  using Word = std::uint64_t;
  static constexpr std::size_t kMostEvents = 1;

  DatDecoder(const RawHeader& header, RawLimits limits, std::span<const std::byte> /*first*/)
      : limits_(limits), origin_us_(header.origin_us) {}

  Event* decode(const std::byte* words, std::size_t count, Event* out) {
    for (std::size_t i = 0; i < count; ++i) {
      const auto time = load<std::uint32_t>(words + i * sizeof(Word));
      const auto place = load<std::uint32_t>(words + i * sizeof(Word) + sizeof time);
      const unsigned x = place & 0x3FFFU;
      const unsigned y = (place >> 14U) & 0x3FFFU;
      if (time < time_) [[unlikely]]
        go_back(time, i);
      time_ = time;
      if (x >= limits_.width || y >= limits_.height) [[unlikely]]
        throw RawError{i, outside_sensor(x, y, limits_)};
      *out++ = {(origin_us_ + wraps_us_ + time) * 1000, static_cast<std::uint16_t>(x),
                static_cast<std::uint16_t>(y),
                static_cast<std::int8_t>((place >> 28U) != 0 ? 1 : -1)};
    }
    return out;
  }

 private:
  /// By more than half of the range: the time wraps.
  void go_back(std::uint32_t time, std::size_t word) {
    constexpr std::uint32_t kHalf = std::uint32_t{1} << 31U;
    if (time_ - time < kHalf)
      throw RawError{word, time_goes_back((origin_us_ + wraps_us_ + time) * 1000,
                                          (origin_us_ + wraps_us_ + time_) * 1000)};
    if (wraps_us_ < kMostTime_us) wraps_us_ += std::int64_t{1} << 32U;
  }

  RawLimits limits_;
  std::int64_t origin_us_;
  std::int64_t wraps_us_ = 0;
  std::uint32_t time_ = 0;
};

}  // namespace

std::unique_ptr<EventReader> open_dat(const std::filesystem::path& file, SensorSize size,
                                      TimeWindow window) {
  return std::make_unique<RawEventReader<DatDecoder>>(file, size, window);
}

}  // namespace saccade
