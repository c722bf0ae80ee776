#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "core/error.h"
#include "core/io/events/aedat/aedat4.h"
#include "core/io/events/aedat/aedat4_event.h"
#include "core/io/events/aedat/aedat4_file.h"
#include "core/process/progress.h"

namespace saccade {
namespace {

Aedat4Stream event_stream(const Aedat4File& file) {
  const std::vector<Aedat4Stream>& streams = file.streams();
  const auto is_events = [](const Aedat4Stream& stream) { return stream.type == "EVTS"; };
  const auto first = std::find_if(streams.begin(), streams.end(), is_events);
  if (first == streams.end())
    throw InputError(file.bytes().name(), "holds no stream of events (of the type EVTS)");
  if (std::count_if(streams.begin(), streams.end(), is_events) > 1)
    show_notice(fmt::format("{} holds several streams of events; the first, number {}, is read",
                            file.bytes().name(), first->id));
  return *first;
}

class Aedat4EventReader final : public EventReader {
 public:
  Aedat4EventReader(const std::filesystem::path& file, SensorSize size, TimeWindow window)
      : file_(file), stream_(event_stream(file_)), window_(window) {
    if (size.width == 0) size = stream_.sensor;
    constexpr int kMost = std::numeric_limits<std::int16_t>::max() + 1;
    width_ = size.width > 0 ? std::min(size.width, kMost) : kMost;
    height_ = size.height > 0 ? std::min(size.height, kMost) : kMost;
  }

  bool read(Events& events) override {
    while (const auto packet = file_.next(stream_.id)) {
      const auto items = items_of(*packet);
      const std::size_t count = items.size() / kAedat4EventBytes;
      if (count == 0) continue;
      const std::size_t before = events.size();
      events.resize(before + count);
      decode(*packet, items, std::span(events).subspan(before));
      if (events.back().t_ns >= window_.start_ns) return true;
      events.resize(before);
    }
    return false;
  }

  [[nodiscard]] SensorSize sensor() const override { return stream_.sensor; }
  [[nodiscard]] std::uint64_t expected_count() const override {
    constexpr std::uint64_t kTypicalPackedBytes = 8;
    return window_.is_everything() ? file_.bytes().size() / kTypicalPackedBytes : 0;
  }

 private:
  [[nodiscard]] std::span<const std::byte> items_of(const Aedat4Packet& packet) const {
    try {
      return FlatTable::root(packet.buffer, "EVTS").structs(kAedat4EventsField, kAedat4EventBytes);
    } catch (const FlatBufferError& error) {
      fail(packet, error.problem);
    }
  }

  void decode(const Aedat4Packet& packet, std::span<const std::byte> items,
              std::span<Event> events) {
    for (std::size_t i = 0; i < events.size(); ++i) {
      const std::byte* item = items.data() + i * kAedat4EventBytes;
      const auto t_us = load<std::int64_t>(item);
      const int x = load<std::int16_t>(item + kAedat4XAt);
      const int y = load<std::int16_t>(item + kAedat4YAt);
      if (x < 0 || y < 0 || x >= width_ || y >= height_ || t_us < last_us_ || t_us > kMostUs)
          [[unlikely]]
        refuse(packet, i, t_us, x, y);
      last_us_ = t_us;
      events[i] = {t_us * 1000, static_cast<std::uint16_t>(x), static_cast<std::uint16_t>(y),
                   static_cast<std::int8_t>(item[kAedat4OnAt] != std::byte{0} ? 1 : -1)};
    }
  }

  [[noreturn]] void refuse(const Aedat4Packet& packet, std::size_t index, std::int64_t t_us, int x,
                           int y) const {
    if (t_us < last_us_ || t_us > kMostUs)
      fail(packet,
           fmt::format("event {}: time goes back: {} us after {} us", index, t_us, last_us_));
    fail(packet, fmt::format("event {}: pixel ({}, {}) lies outside the sensor of {} x {} px",
                             index, x, y, width_, height_));
  }

  [[noreturn]] void fail(const Aedat4Packet& packet, const std::string& problem) const {
    file_.bytes().fail(packet.offset, "in the packet that begins here: " + problem);
  }

  /// Beyond it a time in ns does not fit 64 bits.
  static constexpr std::int64_t kMostUs = std::numeric_limits<std::int64_t>::max() / 1000;

  Aedat4File file_;
  Aedat4Stream stream_;
  TimeWindow window_;
  int width_ = 0;
  int height_ = 0;
  std::int64_t last_us_ = -kMostUs;
};

}  // namespace

std::unique_ptr<EventReader> open_aedat4(const std::filesystem::path& file, SensorSize size,
                                         TimeWindow window) {
  return std::make_unique<Aedat4EventReader>(file, size, window);
}

}  // namespace saccade
