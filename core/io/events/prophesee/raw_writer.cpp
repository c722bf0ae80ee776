#include "core/io/events/prophesee/raw_writer.h"

#include <fmt/format.h>

#include <cerrno>

#include "core/error.h"

namespace saccade {
namespace {

constexpr std::size_t kFlushBytes = std::size_t{1} << 20U;
constexpr int kMostPixels = 2048;  // a side, of 11 bits

}  // namespace

RawEventWriter::RawEventWriter(const std::filesystem::path& file, RawEncoding encoding,
                               SensorSize sensor)
    : target_(file),
      stream_(target_.path(), std::ios::binary),
      encoding_(encoding),
      sensor_(sensor) {
  if (sensor.width > kMostPixels || sensor.height > kMostPixels)
    throw InputError(file.string(),
                     fmt::format("EVT2 and EVT3 hold sensors of up to {0} x {0} px, not {1} x {2}",
                                 kMostPixels, sensor.width, sensor.height));
}

void RawEventWriter::append(std::span<const Event> events) {
  while (!events.empty()) {
    const std::span<const Event> part = events.first(std::min(events.size(), kEventBlock));
    events = events.subspan(part.size());
    events_.add(part);
    write_complete();
  }
}

void RawEventWriter::close() {
  events_.finish();
  write_complete();
  if (!has_header_) write_header(0);
  flush();
  stream_.close();
  if (!stream_) fail_to_write(target_.target(), errno);
  target_.commit();
}

void RawEventWriter::write_complete() {
  while (!events_.complete().empty()) write_block();
}

void RawEventWriter::write_block() {
  const std::span<const Event> events = events_.complete();
  if (!has_header_) write_header(events.front().t_ns);
  for (std::size_t begin = 0; begin < events.size();) {
    std::size_t end = begin;
    for (; end < events.size() && events[end].t_ns == events[begin].t_ns; ++end) check(events[end]);
    encode(events[begin].t_ns / 1000 - origin_us_, events.subspan(begin, end - begin));
    if (data_.size() > kFlushBytes) flush();
    begin = end;
  }
  written_ += events.size();
  events_.drop(events.size());
}

void RawEventWriter::write_header(TimeNs first_ns) {
  origin_us_ = time_origin_ns(first_ns) / 1000;
  data_ = raw_header_text(encoding_, sensor_, origin_us_);
  has_header_ = true;
}

void RawEventWriter::check(const Event& event) const {
  if (event.x < kMostPixels && event.y < kMostPixels) return;
  throw InputError(target_.target().string(),
                   fmt::format("EVT2 and EVT3 hold coordinates below {}; there is an event at "
                               "({}, {})",
                               kMostPixels, event.x, event.y));
}

void RawEventWriter::flush() {
  stream_.write(data_.data(), static_cast<std::streamsize>(data_.size()));
  data_.clear();
  if (!stream_) fail_to_write(target_.target(), errno);
}

}  // namespace saccade
