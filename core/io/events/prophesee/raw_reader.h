#pragma once

#include <fmt/format.h>

#include <filesystem>
#include <limits>
#include <string>
#include <vector>

#include "core/io/events/event_file.h"
#include "core/io/events/prophesee/raw_header.h"
#include "core/io/files/byte_reader.h"

namespace saccade {

/// Columns and rows that events may have; as many as can be written where nothing is known.
struct RawLimits {
  unsigned width = std::numeric_limits<std::uint16_t>::max() + 1U;
  unsigned height = std::numeric_limits<std::uint16_t>::max() + 1U;
};

/// What a word of the data is refused for; the reader adds where it stands.
/// The greatest time [us], 142 years: a file that claims more is noise, and its times would not fit into
/// nanoseconds.
inline constexpr std::int64_t kMostTime_us = std::int64_t{1} << 52U;

struct RawError {
  std::size_t word = 0;  ///< index within what was given to decode()
  std::string problem;
};

/// "pixel (5, 700) lies outside the sensor of 640 x 480 px".
[[nodiscard]] inline std::string outside_sensor(unsigned x, unsigned y, RawLimits limits) {
  return fmt::format("pixel ({}, {}) lies outside the sensor of {} x {} px", x, y, limits.width,
                     limits.height);
}

[[nodiscard]] inline std::string time_goes_back(TimeNs t_ns, TimeNs previous_ns) {
  return fmt::format("time goes back: {:.6f} s after {:.6f} s", seconds_from_ns(t_ns),
                     seconds_from_ns(previous_ns));
}

/// Reads the words of a file behind its header through a Decoder, which is
///   Decoder(const RawHeader&, RawLimits, std::span<const std::byte> first words);
///   using Word, and kMostEvents that one word may give;
///   Event* decode(const std::byte* words, std::size_t count, Event* out), one past the last event.
/// It throws RawError; decode() starts where the last call ended.
template <class Decoder>
class RawEventReader final : public EventReader {
 public:
  RawEventReader(const std::filesystem::path& file, SensorSize size, TimeWindow window)
      : bytes_(file),
        header_(read_raw_header(bytes_)),
        window_(window),
        decoder_(header_, limits(size), bytes_.peek(kBlockWords * sizeof(Word))),
        decoded_(kBlockWords * Decoder::kMostEvents) {}

  bool read(Events& events) override {
    while (true) {
      const auto bytes = bytes_.peek(kBlockWords * sizeof(Word));
      const std::size_t count = std::min(bytes.size() / sizeof(Word), kBlockWords);
      if (count == 0 && !bytes.empty())
        bytes_.fail(bytes_.offset(),
                    fmt::format("the file ends within a word of {} bytes", sizeof(Word)));
      if (count == 0) return false;
      const Event* const end = decode(bytes.data(), count);
      bytes_.skip(count * sizeof(Word));
      const Event* const begin = decoded_.data();
      if (end == begin || (end - 1)->t_ns < window_.start_ns) continue;
      events.insert(events.end(), begin, end);
      return true;
    }
  }

  [[nodiscard]] SensorSize sensor() const override { return header_.sensor; }
  [[nodiscard]] std::uint64_t expected_count() const override {
    return window_.is_everything() ? bytes_.size() / sizeof(Word) : 0;
  }

 private:
  using Word = typename Decoder::Word;
  static constexpr std::size_t kBlockWords = std::size_t{1} << 14U;

  [[nodiscard]] RawLimits limits(SensorSize size) const {
    if (size.width == 0) size = header_.sensor;
    if (size.width == 0) return {};
    return {static_cast<unsigned>(size.width), static_cast<unsigned>(size.height)};
  }

  const Event* decode(const std::byte* words, std::size_t count) {
    try {
      return decoder_.decode(words, count, decoded_.data());
    } catch (const RawError& error) {
      bytes_.fail(bytes_.offset() + error.word * sizeof(Word), error.problem);
    }
  }

  ByteReader bytes_;
  RawHeader header_;
  TimeWindow window_;
  Decoder decoder_;
  std::vector<Event> decoded_;
};

}  // namespace saccade
