#include <algorithm>
#include <span>
#include <vector>

#include "core/io/events/prophesee/evt3.h"
#include "core/io/events/prophesee/evt3_words.h"
#include "core/io/events/prophesee/raw_writer.h"

namespace saccade {
namespace {

constexpr int kVectorColumns = 32;          // by a base, two masks of 12 and one of 8 columns
constexpr std::ptrdiff_t kVectorWords = 4;  // as many events are as short by themselves

class Evt3Writer final : public RawEventWriter {
 public:
  Evt3Writer(const std::filesystem::path& file, SensorSize sensor)
      : RawEventWriter(file, RawEncoding::kEvt3, sensor) {}

 private:
  using Columns = std::vector<std::uint16_t>;

  void encode(std::int64_t t_us, std::span<const Event> events) override {
    move_to(t_us >> 12U);
    if (const auto low = static_cast<unsigned>(t_us & 0xFFF); low != low_)
      put_word(Evt3Type::kTimeLow, low_ = low);
    for (std::size_t begin = 0; begin < events.size();) begin = put_row(events, begin);
  }

  /// Over gaps in steps that the reader can tell from a wrap. With other upper bits the lower ones
  /// are 0.
  void move_to(std::int64_t high) {
    constexpr std::int64_t kStep = kEvt3HalfHigh - 1;
    while (high_ != high) {
      high_ = high_ < 0 ? std::min(high, kStep) : std::min(high, high_ + kStep);
      put_word(Evt3Type::kTimeHigh, static_cast<unsigned>(high_ % kEvt3Highs));
      low_ = 0;
    }
  }

  /// The events of one row and time; returns where they end.
  std::size_t put_row(std::span<const Event> events, std::size_t begin) {
    const unsigned y = events[begin].y;
    if (y != y_) put_word(Evt3Type::kAddressY, y_ = y);
    off_.clear();
    on_.clear();
    std::size_t end = begin;
    for (; end < events.size() && events[end].y == y; ++end)
      (events[end].polarity > 0 ? on_ : off_).push_back(events[end].x);
    put_columns(off_, 0);
    put_columns(on_, 0x800);
    return end;
  }

  /// Ascending columns of one polarity; those close together as a vector.
  void put_columns(const Columns& columns, unsigned polarity) {
    for (auto x = columns.begin(); x != columns.end();) {
      // No mask holds equal columns twice.
      auto end = x + 1;
      while (end != columns.end() && *end < *x + kVectorColumns && *end != *(end - 1)) ++end;
      if (end - x > kVectorWords) {
        put_vector(x, end, polarity);
        x = end;
      } else {
        put_word(Evt3Type::kAddressX, polarity | *x++);
      }
    }
  }

  void put_vector(Columns::const_iterator begin, Columns::const_iterator end, unsigned polarity) {
    std::uint32_t mask = 0;
    for (auto x = begin; x != end; ++x) mask |= std::uint32_t{1} << (*x - *begin);
    put_word(Evt3Type::kVectorBaseX, polarity | *begin);
    put_word(Evt3Type::kVector12, mask & 0xFFFU);
    put_word(Evt3Type::kVector12, mask >> 12U & 0xFFFU);
    put_word(Evt3Type::kVector8, mask >> 24U);
  }

  void put_word(Evt3Type type, unsigned value) {
    put(static_cast<std::uint16_t>(static_cast<unsigned>(type) << 12U | value));
  }

  std::int64_t high_ = -1;
  unsigned low_ = 0;
  unsigned y_ = 2048;  ///< none
  Columns off_;
  Columns on_;
};

}  // namespace

std::unique_ptr<EventWriter> make_evt3_writer(const std::filesystem::path& file,
                                              TimestampUnit /*unit*/, SensorSize sensor) {
  return std::make_unique<Evt3Writer>(file, sensor);
}

}  // namespace saccade
