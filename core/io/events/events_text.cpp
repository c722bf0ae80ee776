#include "core/io/events/events_text.h"

#include <fmt/format.h>

#include <array>
#include <cerrno>
#include <charconv>
#include <fstream>
#include <string>
#include <utility>

#include "core/check.h"
#include "core/error.h"
#include "core/io/files/atomic_file.h"
#include "core/io/files/zip_archive.h"
#include "core/io/tables/text_table.h"

namespace saccade {
namespace {

constexpr const char* kEventColumns = "t x y p";
constexpr std::size_t kTypicalLineBytes = 20;
constexpr std::size_t kFlushBytes = std::size_t{1} << 20;

/// Column or row of an event; `limit` 0 = unknown.
std::uint16_t read_coordinate(TextRow& row, const char* name, int limit) {
  const std::int64_t value = row.integer(name);
  if (value < 0 || value > 65535 || (limit > 0 && value >= limit)) [[unlikely]]
    row.fail(fmt::format("{} = {} lies outside the sensor; it must be 0 ... {}", name, value,
                         limit > 0 ? limit - 1 : 65535));
  return static_cast<std::uint16_t>(value);
}

std::int8_t read_polarity(TextRow& row) {
  const std::int64_t value = row.integer("p");
  if (value < -1 || value > 1) [[unlikely]]
    row.fail(fmt::format("polarity {} must be 0 or 1 (or -1 or 1)", value));
  return value > 0 ? 1 : -1;
}

/// The time of the line, which must not be before `previous`.
TimeNs read_time(TextRow& row, TimeNs previous) {
  const TimeNs t_ns = row.seconds("t");
  if (t_ns < previous) [[unlikely]]
    row.fail(fmt::format("time goes back: {:.9f} s after {:.9f} s", seconds_from_ns(t_ns),
                         seconds_from_ns(previous)));
  return t_ns;
}

void append_field(std::uint16_t value, std::string& text) {
  std::array<char, 8> digits;
  const auto [end, error] = std::to_chars(digits.begin(), digits.end(), value);
  text += ' ';
  text.append(digits.begin(), end);
}

class EventTextReader final : public EventReader {
 public:
  EventTextReader(TextReader reader, std::uint64_t bytes, SensorSize size, TimeWindow window)
      : reader_(std::move(reader)),
        size_(size),
        window_(window),
        expected_(window.is_everything() ? bytes / kTypicalLineBytes : 0) {}

  bool read(Events& events) override {
    const std::size_t before = events.size();
    std::string_view line;
    while (events.size() < before + kEventBlock && reader_.next(line)) {
      TextRow row = reader_.row(line);
      Event event;
      event.t_ns = previous_ = read_time(row, previous_);
      if (event.t_ns >= window_.end_ns) break;
      if (event.t_ns < window_.start_ns) continue;
      event.x = read_coordinate(row, "x", size_.width);
      event.y = read_coordinate(row, "y", size_.height);
      event.polarity = read_polarity(row);
      row.expect_end(kEventColumns);
      events.push_back(event);
    }
    return events.size() > before;
  }

  [[nodiscard]] TimestampUnit unit() const override { return TimestampUnit::kNanoseconds; }
  [[nodiscard]] std::uint64_t expected_count() const override { return expected_; }

 private:
  TextReader reader_;
  SensorSize size_;
  TimeWindow window_;
  TimeNs previous_ = std::numeric_limits<TimeNs>::min();
  std::uint64_t expected_;
};

/// The events.txt that lies least deep; empty where there is none.
std::string events_member(const ZipArchive& archive) {
  std::string best;
  for (const std::string& member : archive.members()) {
    const bool is_events = member == "events.txt" || member.ends_with("/events.txt");
    if (is_events && (best.empty() || member.size() < best.size())) best = member;
  }
  return best;
}

}  // namespace

std::unique_ptr<EventReader> open_events_text(const std::filesystem::path& file, SensorSize size,
                                              TimeWindow window) {
  const std::uint64_t bytes =
      std::filesystem::is_regular_file(file) ? std::filesystem::file_size(file) : 0;
  return std::make_unique<EventTextReader>(TextReader(file), bytes, size, window);
}

std::unique_ptr<EventReader> open_events_zip(const std::filesystem::path& archive, SensorSize size,
                                             TimeWindow window) {
  const auto zip = std::make_shared<ZipArchive>(archive);
  const std::string member = events_member(*zip);
  const auto text = std::make_shared<ZipMember>(*zip, member);
  TextReader reader(zip->location(member), [zip, text](std::span<char> memory) {
    return text->read(std::as_writable_bytes(memory));
  });
  return std::make_unique<EventTextReader>(std::move(reader), 0, size, window);
}

bool is_events_zip(const EventFileHead& head) {
  return head.bytes.starts_with("PK\x03\x04") && !events_member(ZipArchive(head.file)).empty();
}

struct EventTextWriter::State {
  explicit State(const std::filesystem::path& file)
      : target(file), stream(target.path(), std::ios::binary) {}

  void flush() {
    stream.write(buffer.data(), static_cast<std::streamsize>(buffer.size()));
    buffer.clear();
    if (!stream) fail_to_write(target.target(), errno);
  }

  AtomicFile target;
  std::ofstream stream;
  std::string buffer;
  TimeNs last = std::numeric_limits<TimeNs>::min();
  std::uint64_t count = 0;
};

EventTextWriter::EventTextWriter(const std::filesystem::path& file)
    : state_(std::make_unique<State>(file)) {}

EventTextWriter::~EventTextWriter() = default;

void EventTextWriter::append(std::span<const Event> events) {
  for (const Event& event : events) {
    SACCADE_CHECK(event.t_ns >= state_->last);
    state_->last = event.t_ns;
    append_decimal_seconds(event.t_ns, state_->buffer);
    append_field(event.x, state_->buffer);
    append_field(event.y, state_->buffer);
    state_->buffer += event.polarity > 0 ? " 1\n" : " 0\n";
    if (state_->buffer.size() > kFlushBytes) state_->flush();
  }
  state_->count += events.size();
}

void EventTextWriter::close() {
  state_->flush();
  state_->stream.close();
  if (!state_->stream)
    throw InputError(state_->target.target().string(), "cannot be written to its end");
  state_->target.commit();
}

std::uint64_t EventTextWriter::count() const { return state_->count; }

}  // namespace saccade
