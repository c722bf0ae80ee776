#include <algorithm>

#include "core/io/events/prophesee/evt2.h"
#include "core/io/events/prophesee/evt2_words.h"
#include "core/io/events/prophesee/raw_writer.h"

namespace saccade {
namespace {

class Evt2Writer final : public RawEventWriter {
 public:
  Evt2Writer(const std::filesystem::path& file, SensorSize sensor)
      : RawEventWriter(file, RawEncoding::kEvt2, sensor) {}

 private:
  void encode(std::int64_t t_us, std::span<const Event> events) override {
    move_to(t_us >> 6U);
    for (const Event& event : events) {
      const auto type =
          static_cast<std::uint32_t>(event.polarity > 0 ? Evt2Type::kOn : Evt2Type::kOff);
      put<std::uint32_t>(type << 28U | static_cast<std::uint32_t>(t_us & 0x3F) << 22U |
                         static_cast<std::uint32_t>(event.x) << 11U | event.y);
    }
  }

  /// Over gaps in steps that the reader can tell from a wrap.
  void move_to(std::int64_t high) {
    while (high_ != high) {
      high_ = high_ < 0 ? high : std::min(high, high_ + kEvt2Highs / 2 - 1);
      put<std::uint32_t>(static_cast<std::uint32_t>(Evt2Type::kTimeHigh) << 28U |
                         (static_cast<std::uint32_t>(high_) & kEvt2HighMask));
    }
  }

  std::int64_t high_ = -1;
};

}  // namespace

std::unique_ptr<EventWriter> make_evt2_writer(const std::filesystem::path& file,
                                              TimestampUnit /*unit*/, SensorSize sensor) {
  return std::make_unique<Evt2Writer>(file, sensor);
}

}  // namespace saccade
