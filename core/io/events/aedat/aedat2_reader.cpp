#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <limits>
#include <string>
#include <string_view>
#include <utility>

#include "core/error.h"
#include "core/io/events/aedat/aedat2.h"
#include "core/io/files/byte_reader.h"

namespace saccade {
namespace {

constexpr std::size_t kRecordBytes = 8;  // address and time, both big-endian
constexpr std::string_view kChipKey = "# AEChip:";

SensorSize sensor_of_chip(std::string_view chip) {
  constexpr std::array<std::pair<std::string_view, SensorSize>, 5> kChips{{
      {"240", {240, 180}},
      {"346", {346, 260}},
      {"640", {640, 480}},
      {"208", {208, 192}},
      {"128", {128, 128}},
  }};
  std::string name(chip.substr(chip.find_last_of('.') + 1));
  std::transform(name.begin(), name.end(), name.begin(),
                 [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c + 32) : c; });
  for (const auto& [digits, size] : kChips)
    if (name.find("davis") == 0 && name.find(digits) != std::string::npos) return size;
  return {};
}

/// Moves over the lines that begin with '#'; the sensor of the chip that they name.
SensorSize read_header(ByteReader& bytes) {
  constexpr std::size_t kMostLineBytes = std::size_t{1} << 16U;
  std::string chip;
  while (true) {
    const auto ahead = bytes.peek(kMostLineBytes);
    const std::string_view text(reinterpret_cast<const char*>(ahead.data()), ahead.size());
    const std::size_t end = text.substr(0, kMostLineBytes).find('\n');
    if (!text.starts_with('#') || end == std::string_view::npos) break;
    std::string_view line = text.substr(0, end);
    if (line.ends_with('\r')) line.remove_suffix(1);
    if (line.starts_with(kChipKey)) chip = line.substr(kChipKey.size());
    bytes.skip(end + 1);
  }
  const SensorSize sensor = sensor_of_chip(chip);
  if (sensor.width > 0) return sensor;
  const std::string found = chip.empty() ? "has no such line" : "names" + chip;
  bytes.fail(0,
             fmt::format("the header must name the camera in a line \"{} ...\", one of DAVIS128, "
                         "208, 240, 346 or 640, whose addresses are known; it {}",
                         kChipKey, found));
}

std::uint32_t load_big_endian(const std::byte* bytes) {
  return __builtin_bswap32(load<std::uint32_t>(bytes));
}

class Aedat2Reader final : public EventReader {
 public:
  Aedat2Reader(const std::filesystem::path& file, SensorSize size, TimeWindow window)
      : bytes_(file), sensor_(read_header(bytes_)), window_(window) {
    if (size.width > 0) limits_ = size;
    if (size.width == 0) limits_ = sensor_;
  }

  bool read(Events& events) override {
    const std::size_t before = events.size();
    while (events.size() == before) {
      const auto bytes = bytes_.peek(kEventBlock * kRecordBytes);
      const std::size_t count = std::min(bytes.size() / kRecordBytes, kEventBlock);
      if (count == 0 && !bytes.empty())
        bytes_.fail(bytes_.offset(), "the file ends within an event of 8 bytes");
      if (count == 0) return false;
      for (std::size_t i = 0; i < count; ++i) add(bytes.data() + i * kRecordBytes, i, events);
      bytes_.skip(count * kRecordBytes);
      if (!events.empty() && events.back().t_ns < window_.start_ns) events.resize(before);
    }
    return true;
  }

  [[nodiscard]] SensorSize sensor() const override { return sensor_; }
  [[nodiscard]] std::uint64_t expected_count() const override {
    return window_.is_everything() ? bytes_.size() / kRecordBytes : 0;
  }

 private:
  /// Appends the record if it is of an event.
  void add(const std::byte* record, std::size_t index, Events& events) {
    constexpr std::uint32_t kNoPixelEvent = 0x80000400;  // frames, inertial samples; triggers
    const std::uint32_t address = load_big_endian(record);
    if ((address & kNoPixelEvent) != 0) return;
    const auto x = sensor_.width - 1 - static_cast<int>(address >> 12U & 0x3FFU);
    const auto y = sensor_.height - 1 - static_cast<int>(address >> 22U & 0x1FFU);
    if (x < 0 || y < 0 || x >= limits_.width || y >= limits_.height) [[unlikely]]
      fail(index, fmt::format("pixel ({}, {}) lies outside the sensor of {} x {} px", x, y,
                              limits_.width, limits_.height));
    const std::uint32_t time = load_big_endian(record + sizeof address);
    if (time < time_) [[unlikely]]
      go_back(time, index);
    time_ = time;
    events.push_back({(wraps_us_ + time) * 1000, static_cast<std::uint16_t>(x),
                      static_cast<std::uint16_t>(y),
                      static_cast<std::int8_t>((address & 0x800U) != 0 ? 1 : -1)});
  }

  /// By more than half of the range: the time wraps.
  void go_back(std::uint32_t time, std::size_t index) {
    constexpr std::uint32_t kHalf = std::uint32_t{1} << 31U;
    if (time_ - time < kHalf)
      fail(index, fmt::format("time goes back: {} us after {} us", time, time_));
    wraps_us_ += std::int64_t{1} << 32U;
  }

  [[noreturn]] void fail(std::size_t index, const std::string& problem) const {
    bytes_.fail(bytes_.offset() + index * kRecordBytes, problem);
  }

  ByteReader bytes_;
  SensorSize sensor_;
  SensorSize limits_;
  TimeWindow window_;
  std::uint32_t time_ = 0;
  std::int64_t wraps_us_ = 0;
};

}  // namespace

std::unique_ptr<EventReader> open_aedat2(const std::filesystem::path& file, SensorSize size,
                                         TimeWindow window) {
  return std::make_unique<Aedat2Reader>(file, size, window);
}

}  // namespace saccade
