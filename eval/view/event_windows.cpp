#include "eval/view/event_windows.h"

#include <algorithm>
#include <span>
#include <utility>
#include <vector>

#include "core/check.h"
#include "core/error.h"
#include "core/io/events/event_formats.h"

namespace saccade {
namespace {

constexpr unsigned kOffBit = 0x8000;

bool is_hdf5(const std::filesystem::path& file) {
  return recognise_event_format(file).open == &open_events_h5;
}

void copy_events(const std::filesystem::path& from, SensorSize size,
                 const std::filesystem::path& to) {
  EventStream stream(from, size);
  EventH5Writer writer(to, TimestampUnit::kNanoseconds, size);
  for (auto events = stream.next(); !events.empty(); events = stream.next()) writer.append(events);
  writer.close();
}

template <class T>
void append_bytes(std::string& bytes, const std::vector<T>& values) {
  const auto raw = std::as_bytes(std::span(values));
  bytes.append(reinterpret_cast<const char*>(raw.data()), raw.size());
}

}  // namespace

EventWindows::EventWindows(std::filesystem::path file, SensorSize size)
    : file_(std::move(file)), size_(size) {}

const EventH5Reader& EventWindows::reader() const {
  const std::lock_guard lock(mutex_);
  if (reader_) return *reader_;
  if (is_hdf5(file_)) {
    reader_ = std::make_unique<const EventH5Reader>(file_);
    return *reader_;
  }
  copy_.emplace();
  const std::filesystem::path copy = copy_->path() / "events.h5";
  copy_events(file_, size_, copy);
  reader_ = std::make_unique<const EventH5Reader>(copy);
  return *reader_;
}

EventFileInfo EventWindows::info() const { return reader().info(); }

std::uint64_t EventWindows::count(TimeWindow window) const {
  const auto [begin, end] = reader().range(window);
  return end - begin;
}

void EventWindows::visit(TimeWindow window,
                         const std::function<void(std::uint64_t, const Event&)>& use) const {
  const EventH5Reader& events = reader();
  const auto [begin, end] = events.range(window);
  Events block;
  for (std::uint64_t at = begin; at < end; at += kEventBlock) {
    block.clear();
    events.append(at, std::min<std::uint64_t>(at + kEventBlock, end), size_, block);
    for (std::size_t i = 0; i < block.size(); ++i) use(at + i, block[i]);
  }
}

std::string pack_events(const EventWindows& events, std::int64_t start_us, std::int64_t end_us,
                        std::uint64_t every) {
  SACCADE_CHECK(every > 0 && start_us <= end_us && end_us - start_us <= kLongestPacked_us);
  const TimeWindow window{start_us * kNsPerUs, end_us * kNsPerUs};
  const std::uint64_t kept = events.count(window) / every;
  const std::uint64_t stride = every * (1 + kept / (kMostPackedEvents + 1));
  EventPacker packer(start_us);
  events.visit(window, [&](std::uint64_t index, const Event& event) {
    if (index % stride == 0) packer.add(event);
  });
  return packer.bytes(static_cast<std::uint32_t>(stride));
}

EventPacker::EventPacker(std::int64_t start_us) : start_ns_(start_us * kNsPerUs) {}

void EventPacker::add(const Event& event) {
  if (event.x >= kOffBit) throw InputError("events", "columns beyond 32767 are not drawn");
  times_.push_back(static_cast<std::uint32_t>((event.t_ns - start_ns_) / kNsPerUs));
  columns_.push_back(static_cast<std::uint16_t>(event.x | (event.polarity > 0 ? 0U : kOffBit)));
  rows_.push_back(event.y);
}

std::string EventPacker::bytes(std::uint32_t stride) const {
  std::string bytes;
  bytes.reserve(8 + 8 * times_.size());
  append_bytes(bytes,
               std::vector<std::uint32_t>{static_cast<std::uint32_t>(times_.size()), stride});
  append_bytes(bytes, times_);
  append_bytes(bytes, columns_);
  append_bytes(bytes, rows_);
  return bytes;
}

}  // namespace saccade
