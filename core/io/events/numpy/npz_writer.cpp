#include <array>
#include <cerrno>
#include <fstream>
#include <string>
#include <utility>
#include <vector>

#include "core/check.h"
#include "core/io/events/numpy/numpy_events.h"
#include "core/io/events/rounded_events.h"
#include "core/io/files/atomic_file.h"
#include "core/io/files/zip_archive.h"
#include "core/io/tables/npy_header.h"

namespace saccade {
namespace {

namespace fs = std::filesystem;

/// Columns grow in files beside the archive, which lays them behind one another.
class NpzWriter final : public EventWriter {
 public:
  NpzWriter(const fs::path& file, TimestampUnit unit, SensorSize sensor)
      : target_(file),
        folder_(target_.path().string() + ".columns", "t"),
        unit_(unit),
        sensor_(sensor),
        events_(unit) {
    for (std::size_t i = 0; i < kColumns.size(); ++i) {
      columns_[i].open(column_file(i), std::ios::binary);
      columns_[i] << header(i, 0);
    }
  }

  void append(std::span<const Event> events) override {
    while (!events.empty()) {
      const std::span<const Event> part = events.first(std::min(events.size(), kEventBlock));
      events = events.subspan(part.size());
      events_.add(part);
      write_complete();
    }
  }

  void close() override {
    events_.finish();
    write_complete();
    std::vector<std::pair<std::string, fs::path>> files;
    for (std::size_t i = 0; i < kColumns.size(); ++i) {
      columns_[i].seekp(0);
      columns_[i] << header(i, written_);
      columns_[i].close();
      if (!columns_[i]) fail_to_write(target_.target(), errno);
      files.emplace_back(std::string(kColumns[i].name) + ".npy", column_file(i));
    }
    add_text(unit_ == TimestampUnit::kNanoseconds ? "ns" : "us", files);
    if (sensor_.width > 0) {
      add_number("width", sensor_.width, files);
      add_number("height", sensor_.height, files);
    }
    write_zip(target_.path(), files);
    target_.commit();
  }

  [[nodiscard]] std::uint64_t count() const override { return written_ + events_.size(); }

 private:
  struct Column {
    std::string_view name, type;
  };
  static constexpr std::array<Column, 4> kColumns{
      {{"t", "<i8"}, {"x", "<u2"}, {"y", "<u2"}, {"p", "|u1"}}};

  [[nodiscard]] fs::path column_file(std::size_t column) const {
    return folder_.path() / kColumns[column].name;
  }

  /// The number of events is known at the end alone: the header has room for any.
  static std::string header(std::size_t column, std::uint64_t count) {
    constexpr std::uint64_t kMostEvents = 1'000'000'000'000'000;
    const std::string widest = npy_header_text(kColumns[column].type, {kMostEvents});
    std::string text = npy_header_text(kColumns[column].type, {count});
    SACCADE_CHECK(text.size() == widest.size());
    return text;
  }

  void write_complete() {
    while (!events_.complete().empty()) write_block();
  }

  void write_block() {
    const std::span<const Event> events = events_.complete();
    const TimeNs ns_per_unit = unit_ == TimestampUnit::kNanoseconds ? 1 : 1000;
    write<std::int64_t>(0, events, [=](const Event& e) { return e.t_ns / ns_per_unit; });
    write<std::uint16_t>(1, events, [](const Event& e) { return e.x; });
    write<std::uint16_t>(2, events, [](const Event& e) { return e.y; });
    write<std::uint8_t>(3, events, [](const Event& e) { return e.polarity > 0 ? 1 : 0; });
    written_ += events.size();
    events_.drop(events.size());
  }

  template <class T, class Value>
  void write(std::size_t column, std::span<const Event> events, const Value& value) {
    std::vector<T> values;
    values.reserve(events.size());
    for (const Event& event : events) values.push_back(static_cast<T>(value(event)));
    columns_[column].write(reinterpret_cast<const char*>(values.data()),
                           static_cast<std::streamsize>(values.size() * sizeof(T)));
    if (!columns_[column]) fail_to_write(target_.target(), errno);
  }

  using Files = std::vector<std::pair<std::string, fs::path>>;

  void add_text(std::string_view text, Files& files) const {
    std::string bytes = npy_header_text("<U" + std::to_string(text.size()), {});
    for (const char c : text) bytes += {c, '\0', '\0', '\0'};
    add("t_unit", bytes, files);
  }
  void add_number(const std::string& name, std::int64_t value, Files& files) const {
    std::string bytes = npy_header_text("<i8", {});
    bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
    add(name, bytes, files);
  }
  void add(const std::string& name, const std::string& bytes, Files& files) const {
    write_atomically(folder_.path() / name, bytes);
    files.emplace_back(name + ".npy", folder_.path() / name);
  }

  AtomicFile target_;
  AtomicFolder folder_;
  TimestampUnit unit_;
  SensorSize sensor_;
  RoundedEvents events_;
  std::array<std::ofstream, 4> columns_;
  std::uint64_t written_ = 0;
};

}  // namespace

std::unique_ptr<EventWriter> make_npz_writer(const std::filesystem::path& file, TimestampUnit unit,
                                             SensorSize sensor) {
  return std::make_unique<NpzWriter>(file, unit, sensor);
}

}  // namespace saccade
