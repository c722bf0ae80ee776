#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "core/error.h"
#include "core/io/events/numpy/numpy_events.h"
#include "core/io/events/numpy/numpy_source.h"

namespace saccade {
namespace {

/// Column of an event and where it lies in the blocks of an array.
struct EventColumn {
  std::size_t array = 0;  ///< index
  NpyField field;
};

struct Layout {
  std::vector<NumpyArray> arrays;
  EventColumn t, x, y, p;
  TimeNs unit_ns = 1000;  ///< of whole times
  SensorSize sensor;
};

std::optional<NpyField> find_field(const NpyHeader& header,
                                   std::initializer_list<std::string_view> names) {
  for (const std::string_view name : names)
    for (const NpyField& field : header.fields)
      if (field.name == name) return field;
  return std::nullopt;
}

/// Fields by the names that tools give them.
std::optional<Layout> structured(NumpyArray array) {
  const NpyHeader& header = array.header();
  const auto t = find_field(header, {"t", "ts", "timestamp", "timestamps", "time"});
  const auto x = find_field(header, {"x"});
  const auto y = find_field(header, {"y"});
  const auto p = find_field(header, {"p", "pol", "polarity", "on"});
  if (!t || !x || !y || !p || header.shape.size() != 1) return std::nullopt;
  Layout layout{{}, {0, *t}, {0, *x}, {0, *y}, {0, *p}, 1000, {}};
  layout.arrays.push_back(std::move(array));
  return layout;
}

/// N rows t, x, y, p.
std::optional<Layout> plain(NumpyArray array) {
  NpyHeader header = array.header();
  if (header.fields.size() != 1 || header.shape.size() != 2 || header.shape[1] != 4 ||
      header.is_fortran)
    return std::nullopt;
  NpyField field = header.fields.front();
  Layout layout;
  for (EventColumn* column : {&layout.t, &layout.x, &layout.y, &layout.p}) {
    *column = {0, field};
    field.offset += field.type.bytes;
  }
  array.set_row_bytes(4 * field.type.bytes);
  layout.arrays.push_back(std::move(array));
  return layout;
}

[[noreturn]] void fail_layout(const std::string& location) {
  throw InputError(location,
                   "holds no events: it must be an array with the fields t, x, y and p, an array "
                   "of N rows t, x, y, p (not in Fortran's order), or an archive of arrays t, x, y "
                   "and p");
}

Layout single(NumpyArray array) {
  const std::string location = array.location();
  const bool is_structured = array.header().fields.size() > 1;
  auto layout = is_structured ? structured(std::move(array)) : plain(std::move(array));
  if (!layout) fail_layout(location);
  return std::move(*layout);
}

/// A number beside the events; `absent` where there is none.
std::int64_t side_number(const NumpyFile& file, const std::string& name, std::int64_t absent) {
  if (!file.contains(name)) return absent;
  NumpyArray array = file.open(name);
  const std::span<const std::byte> bytes = array.read(1);
  const NpyField& field = array.header().fields.front();
  std::vector<std::int64_t> value;
  if (bytes.empty()) return absent;
  read_whole_numbers(bytes, array.row_bytes(), field, value);
  return value.front();
}

Layout of_archive(const NumpyFile& file) {
  Layout layout;
  if (!(file.contains("t") && file.contains("x") && file.contains("y") && file.contains("p"))) {
    if (file.names().size() != 1) fail_layout(file.location());
    return single(file.open(file.names().front()));
  }
  std::size_t index = 0;
  for (const auto& [name, column] : {std::pair{"t", &layout.t}, std::pair{"x", &layout.x},
                                     std::pair{"y", &layout.y}, std::pair{"p", &layout.p}}) {
    layout.arrays.push_back(file.open(name));
    const NumpyArray& array = layout.arrays.back();
    if (array.header().shape.size() != 1 || array.header().fields.size() != 1)
      throw InputError(array.location(), "must be an array of numbers of one dimension");
    if (array.rows() != layout.arrays.front().rows())
      throw InputError(array.location(), fmt::format("has {} entries, t has {}", array.rows(),
                                                     layout.arrays.front().rows()));
    *column = {index++, array.header().fields.front()};
  }
  if (file.contains("t_unit") && file.open("t_unit").text() == "ns") layout.unit_ns = 1;
  layout.sensor = {
      static_cast<int>(std::clamp<std::int64_t>(side_number(file, "width", 0), 0, 65536)),
      static_cast<int>(std::clamp<std::int64_t>(side_number(file, "height", 0), 0, 65536))};
  return layout;
}

class NumpyReader final : public EventReader {
 public:
  NumpyReader(const std::filesystem::path& path, SensorSize size, TimeWindow window)
      : file_(path),
        layout_(file_.is_archive() ? of_archive(file_) : single(file_.open(""))),
        window_(window) {
    if (size.width == 0) size = layout_.sensor;
    width_ = size.width > 0 ? size.width : 65536;
    height_ = size.height > 0 ? size.height : 65536;
  }

  bool read(Events& events) override {
    const std::size_t before = events.size();
    while (events.size() == before) {
      if (!read_block()) return false;
      append(events);
      index_ += t_.size();
      if (events.back().t_ns < window_.start_ns) events.resize(before);
    }
    return true;
  }

  [[nodiscard]] SensorSize sensor() const override { return layout_.sensor; }
  [[nodiscard]] TimestampUnit unit() const override {
    const bool is_us = layout_.unit_ns == 1000 && layout_.t.field.type.kind != 'f';
    return is_us ? TimestampUnit::kMicroseconds : TimestampUnit::kNanoseconds;
  }
  [[nodiscard]] std::uint64_t expected_count() const override {
    constexpr std::uint64_t kTypicalBytes = 13;
    return window_.is_everything() ? file_.size() / kTypicalBytes : 0;
  }

 private:
  bool read_block() {
    blocks_.clear();
    for (NumpyArray& array : layout_.arrays) blocks_.push_back(array.read(kEventBlock));
    if (blocks_.front().empty()) return false;
    if (layout_.t.field.type.kind == 'f')
      read_seconds(block(layout_.t), row_bytes(layout_.t), layout_.t.field, t_);
    else
      read_whole(layout_.t, t_);
    read_whole(layout_.x, x_);
    read_whole(layout_.y, y_);
    read_whole(layout_.p, p_);
    return true;
  }

  [[nodiscard]] std::span<const std::byte> block(const EventColumn& column) const {
    return blocks_[column.array];
  }
  [[nodiscard]] std::size_t row_bytes(const EventColumn& column) const {
    return layout_.arrays[column.array].row_bytes();
  }
  void read_whole(const EventColumn& column, std::vector<std::int64_t>& values) const {
    read_whole_numbers(block(column), row_bytes(column), column.field, values);
  }

  void append(Events& events) {
    const TimeNs unit = layout_.t.field.type.kind == 'f' ? 1 : layout_.unit_ns;
    const TimeNs most = std::numeric_limits<TimeNs>::max() / unit;
    for (std::size_t i = 0; i < t_.size(); ++i) {
      if (x_[i] < 0 || y_[i] < 0 || x_[i] >= width_ || y_[i] >= height_) [[unlikely]]
        fail(i, fmt::format("pixel ({}, {}) lies outside the sensor of {} x {} px", x_[i], y_[i],
                            width_, height_));
      if (p_[i] < -1 || p_[i] > 1) [[unlikely]]
        fail(i, fmt::format("polarity {} must be 0 or 1 (or -1 or 1)", p_[i]));
      if (t_[i] < last_ || t_[i] > most || t_[i] < -most) [[unlikely]]
        fail(i, fmt::format("time goes back: {} after {}", t_[i], last_));
      last_ = t_[i];
      events.push_back({t_[i] * unit, static_cast<std::uint16_t>(x_[i]),
                        static_cast<std::uint16_t>(y_[i]),
                        static_cast<std::int8_t>(p_[i] > 0 ? 1 : -1)});
    }
  }

  [[noreturn]] void fail(std::size_t index, const std::string& problem) const {
    throw InputError(fmt::format("{}:[{}]", file_.location(), index_ + index), problem);
  }

  NumpyFile file_;
  Layout layout_;
  TimeWindow window_;
  std::int64_t width_ = 0;
  std::int64_t height_ = 0;
  std::int64_t last_ = std::numeric_limits<std::int64_t>::min();
  std::uint64_t index_ = 0;  ///< of the block's first event
  std::vector<std::span<const std::byte>> blocks_;
  std::vector<std::int64_t> t_, x_, y_, p_;
};

}  // namespace

std::unique_ptr<EventReader> open_numpy(const std::filesystem::path& file, SensorSize size,
                                        TimeWindow window) {
  return std::make_unique<NumpyReader>(file, size, window);
}

bool is_npy(const EventFileHead& head) { return head.bytes.starts_with(kNpyMagic); }

bool is_npz(const EventFileHead& head) {
  if (!head.bytes.starts_with("PK\x03\x04")) return false;
  const std::vector<std::string> members = ZipArchive(head.file).members();
  return std::any_of(members.begin(), members.end(),
                     [](const std::string& member) { return member.ends_with(".npy"); });
}

}  // namespace saccade
