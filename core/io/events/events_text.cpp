#include "core/io/events/events_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <fstream>
#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/check.h"
#include "core/error.h"
#include "core/io/events/usual_line.h"
#include "core/io/files/atomic_file.h"
#include "core/io/files/zip_archive.h"
#include "core/io/tables/text_table.h"
#include "core/process/background_task.h"
#include "core/process/parallel.h"

namespace saccade {
namespace {

constexpr const char* kEventColumns = "t x y p";
constexpr std::size_t kTypicalLineBytes = 20;

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

/// Text that one thread parses at a time, and events that one thread writes at a time.
constexpr std::size_t kPartBytes = std::size_t{1} << 17;
constexpr std::size_t kPartEvents = std::size_t{1} << 14;

char* write_field(std::uint16_t value, char* to) {
  *to++ = ' ';
  return std::to_chars(to, to + 5, value).ptr;
}

/// "t x y p\n" to where there is room for kMostLineBytes; gives the end.
constexpr std::size_t kMostLineBytes = kMostDecimalSeconds + 2 * 6 + 3;
char* write_line(const Event& event, char* to) {
  to = write_decimal_seconds(event.t_ns, to);
  to = write_field(event.x, to);
  to = write_field(event.y, to);
  for (const char c : {' ', event.polarity > 0 ? '1' : '0', '\n'}) *to++ = c;
  return to;
}

/// What some consecutive lines hold.
struct ParsedLines {
  Events events = {};
  std::optional<TimeNs> first_ns = std::nullopt;  ///< of the lines, also of those before the window
  TimeNs last_ns = 0;
  std::size_t lines = 0;
  bool is_over = false;   ///< whether the window ends in them
  bool is_wrong = false;  ///< whether they have to be parsed again, for the error
};

class EventTextReader final : public EventReader {
 public:
  EventTextReader(TextReader reader, std::uint64_t bytes, SensorSize size, TimeWindow window)
      : reader_(std::move(reader)),
        size_(size),
        window_(window),
        expected_(window.is_everything() ? bytes / kTypicalLineBytes : 0) {}

  bool read(Events& events) override {
    const std::size_t before = events.size();
    while (!is_over_ && events.size() == before) {
      const std::string_view text = reader_.next_lines();
      is_over_ = text.empty();
      const std::vector<std::string_view> parts = divide_lines(text, kPartBytes);
      std::vector<ParsedLines> parsed(parts.size());
      parallel_for(parts.size(), [&](std::size_t i) { parsed[i] = try_parse(parts[i]); });
      for (std::size_t i = 0; i < parts.size() && !is_over_; ++i) {
        if (parsed[i].is_wrong || parsed[i].first_ns.value_or(previous_) < previous_)
          parsed[i] = parse(parts[i], lines_, previous_);
        take(parsed[i], events);
      }
    }
    return events.size() > before;
  }

  [[nodiscard]] TimestampUnit unit() const override { return TimestampUnit::kNanoseconds; }
  [[nodiscard]] std::uint64_t expected_count() const override { return expected_; }

 private:
  static constexpr TimeNs kAnyTime = std::numeric_limits<TimeNs>::min();

  /// Without what comes before, which is not known yet: neither the number of the lines nor the time.
  [[nodiscard]] ParsedLines try_parse(std::string_view text) const {
    try {
      return parse(text, 0, kAnyTime);
    } catch (const InputError&) {
      return {.is_wrong = true};
    }
  }

  /// InputError for the first line that is wrong, after `before` lines and the time `previous`.
  [[nodiscard]] ParsedLines parse(std::string_view text, std::size_t before,
                                  TimeNs previous) const {
    ParsedLines result;
    result.events.reserve(text.size() / kTypicalLineBytes);
    result.last_ns = previous;
    TextLines lines(reader_.name(), text, before);
    std::string_view line;
    Event event;
    for (;;) {
      const std::size_t length = read_usual_line(lines.rest(), event);
      if (length > 0 && event.t_ns >= result.last_ns && event.t_ns < window_.end_ns &&
          is_on_sensor(event)) {
        lines.skip_line(length);
        result.last_ns = event.t_ns;
        if (!result.first_ns) result.first_ns = event.t_ns;
        if (event.t_ns >= window_.start_ns) result.events.push_back(event);
        continue;
      }
      if (!lines.next(line)) break;
      TextRow row = lines.row(line);
      event.t_ns = result.last_ns = read_time(row, result.last_ns);
      if (!result.first_ns) result.first_ns = event.t_ns;
      result.is_over = event.t_ns >= window_.end_ns;
      if (result.is_over) break;
      if (event.t_ns < window_.start_ns) continue;
      event.x = read_coordinate(row, "x", size_.width);
      event.y = read_coordinate(row, "y", size_.height);
      event.polarity = read_polarity(row);
      row.expect_end(kEventColumns);
      result.events.push_back(event);
    }
    result.lines = lines.line_number() - before;
    return result;
  }

  [[nodiscard]] bool is_on_sensor(const Event& event) const {
    return (size_.width <= 0 || event.x < size_.width) &&
           (size_.height <= 0 || event.y < size_.height);
  }

  void take(const ParsedLines& parsed, Events& events) {
    events.insert(events.end(), parsed.events.begin(), parsed.events.end());
    if (parsed.first_ns) previous_ = parsed.last_ns;
    lines_ += parsed.lines;
    reader_.count_lines(parsed.lines);
    is_over_ = parsed.is_over;
  }

  TextReader reader_;
  SensorSize size_;
  TimeWindow window_;
  TimeNs previous_ = kAnyTime;
  std::size_t lines_ = 0;  ///< read so far
  bool is_over_ = false;
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

  void add(std::span<const Event> events);
  void hand_over();
  void write_batch();

  AtomicFile target;
  std::ofstream stream;
  Events pending;  ///< not yet handed over
  Events batch;    ///< that is being written
  TimeNs last = std::numeric_limits<TimeNs>::min();
  std::uint64_t count = 0;
  BackgroundTask writing;  ///< of the batch; last, so that it ends before the rest does
};

void EventTextWriter::State::add(std::span<const Event> events) {
  constexpr std::size_t kBatchEvents = 16 * kPartEvents;
  for (const Event& event : events) {
    SACCADE_CHECK(event.t_ns >= last);
    last = event.t_ns;
  }
  count += events.size();
  while (!events.empty()) {
    const std::size_t room = std::min(events.size(), kBatchEvents - pending.size());
    pending.insert(pending.end(), events.begin(),
                   events.begin() + static_cast<std::ptrdiff_t>(room));
    events = events.subspan(room);
    if (pending.size() == kBatchEvents) hand_over();
  }
}

/// Gives what is pending to be written beside the caller's work.
void EventTextWriter::State::hand_over() {
  writing.wait();
  std::swap(batch, pending);
  pending.clear();
  writing.start([this] { write_batch(); });
}

void EventTextWriter::State::write_batch() {
  std::vector<std::string> parts((batch.size() + kPartEvents - 1) / kPartEvents);
  parallel_for(parts.size(), [&](std::size_t i) {
    const std::size_t begin = i * kPartEvents;
    const std::size_t end = std::min(begin + kPartEvents, batch.size());
    parts[i].resize((end - begin) * kMostLineBytes);
    char* to = parts[i].data();
    for (std::size_t k = begin; k < end; ++k) to = write_line(batch[k], to);
    parts[i].resize(static_cast<std::size_t>(to - parts[i].data()));
  });
  for (const std::string& part : parts)
    stream.write(part.data(), static_cast<std::streamsize>(part.size()));
  if (!stream) fail_to_write(target.target(), errno);
}

EventTextWriter::EventTextWriter(const std::filesystem::path& file)
    : state_(std::make_unique<State>(file)) {}

EventTextWriter::~EventTextWriter() = default;

void EventTextWriter::append(std::span<const Event> events) { state_->add(events); }

void EventTextWriter::close() {
  state_->hand_over();
  state_->writing.wait();
  state_->stream.close();
  if (!state_->stream)
    throw InputError(state_->target.target().string(), "cannot be written to its end");
  state_->target.commit();
}

std::uint64_t EventTextWriter::count() const { return state_->count; }

}  // namespace saccade
