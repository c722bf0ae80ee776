#include <algorithm>
#include <array>
#include <string>
#include <vector>

#include "core/error.h"
#include "core/io/events/events_h5.h"
#include "core/io/events/rounded_events.h"
#include "core/io/files/atomic_file.h"
#include "core/io/tables/h5_column.h"
#include "core/process/background_task.h"
#include "core/process/parallel.h"

namespace saccade {
namespace {

/// The index takes 8 bytes for each millisecond, events or not: half a gigabyte for these.
constexpr std::int64_t kMaxIndexMs = std::int64_t{1} << 26;

struct PackedChunk {
  std::array<H5Chunk, 4> columns;  ///< x, y, p, t
};

/// `unit` is 1 or 1000 ns: a constant divides many times faster than a variable.
std::int64_t in_ticks(TimeNs t_ns, TimeNs unit) { return unit == 1 ? t_ns : t_ns / 1000; }

PackedChunk pack(std::span<const Event> events, TimeNs unit, TimeNs offset) {
  std::vector<std::uint16_t> x(kH5ChunkValues);
  std::vector<std::uint16_t> y(kH5ChunkValues);
  std::vector<std::uint8_t> p(kH5ChunkValues);
  std::vector<std::int64_t> t(kH5ChunkValues);
  for (std::size_t i = 0; i < events.size(); ++i) {
    x[i] = events[i].x;
    y[i] = events[i].y;
    p[i] = events[i].polarity > 0 ? 1 : 0;
    t[i] = in_ticks(events[i].t_ns, unit) - offset;
  }
  return {{pack_h5_chunk(x), pack_h5_chunk(y), pack_h5_chunk(p), pack_h5_chunk(t)}};
}

}  // namespace

struct EventH5Writer::State {
  State(const std::filesystem::path& file_name, TimestampUnit timestamp_unit, SensorSize sensor)
      : target(file_name),
        unit(timestamp_unit == TimestampUnit::kMicroseconds ? 1000 : 1),
        ticks_per_ms(1'000'000 / unit),
        pending(timestamp_unit) {
    const H5Lock lock;
    file = {H5Fcreate(target.path().c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT), H5Fclose};
    check(file.valid());
    const H5Handle group = {H5Gcreate2(file, "events", H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT),
                            H5Gclose};
    columns[0] = {group, "x", H5T_STD_U16LE, target.target()};
    columns[1] = {group, "y", H5T_STD_U16LE, target.target()};
    columns[2] = {group, "p", H5T_STD_U8LE, target.target()};
    columns[3] = {group, "t", H5T_STD_I64LE, target.target()};
    write_unit(columns[3].id());
    if (sensor.width == 0) return;
    write_size(group, "width", sensor.width);
    write_size(group, "height", sensor.height);
  }

  void check(bool success) const { check_h5_write(success, target.target()); }

  void write_unit(hid_t dataset) const {
    const H5Handle type = {H5Tcopy(H5T_C_S1), H5Tclose};
    H5Tset_size(type, 2);
    const H5Handle space = {H5Screate(H5S_SCALAR), H5Sclose};
    const H5Handle attribute = {H5Acreate2(dataset, "unit", type, space, H5P_DEFAULT, H5P_DEFAULT),
                                H5Aclose};
    check(attribute.valid() && H5Awrite(attribute, type, unit == 1 ? "ns" : "us") >= 0);
  }

  void write_size(hid_t group, const char* name, int pixels) const {
    const H5Handle space = {H5Screate(H5S_SCALAR), H5Sclose};
    const H5Handle attribute = {
        H5Acreate2(group, name, H5T_STD_I32LE, space, H5P_DEFAULT, H5P_DEFAULT), H5Aclose};
    check(attribute.valid() && H5Awrite(attribute, H5T_NATIVE_INT, &pixels) >= 0);
  }

  void add(std::span<const Event> events);
  void hand_over();
  void write_batch();
  void index();
  void finish();

  AtomicFile target;
  TimeNs unit;  ///< [ns]
  std::int64_t ticks_per_ms;
  H5Handle file;
  std::array<H5Column, 4> columns;
  RoundedEvents pending;  ///< not yet handed over
  std::uint64_t handed_over = 0;
  // What follows belongs to `writing` until it has been waited for.
  Events batch;
  std::int64_t offset = 0;  ///< /t_offset [ticks]
  std::uint64_t written = 0;
  std::vector<std::uint64_t> ms_to_idx;
  BackgroundTask writing;  ///< of the batch; last, so that it ends before the rest does
};

void EventH5Writer::State::add(std::span<const Event> events) {
  // In parts, so that what is pending stays small however long the span is.
  while (!events.empty()) {
    const std::span<const Event> part = events.first(std::min(events.size(), kH5BatchValues));
    events = events.subspan(part.size());
    pending.add(part);
    while (pending.complete().size() >= kH5BatchValues) hand_over();
  }
}

/// Gives a batch of complete events, or the last ones, to be packed and written beside the caller's work.
void EventH5Writer::State::hand_over() {
  writing.wait();
  const std::span<const Event> events =
      pending.complete().first(std::min(kH5BatchValues, pending.complete().size()));
  batch.assign(events.begin(), events.end());
  pending.drop(batch.size());
  handed_over += batch.size();
  writing.start([this] { write_batch(); });
}

/// Every chunk but the last one of all is full.
void EventH5Writer::State::write_batch() {
  index();
  std::vector<PackedChunk> packed((batch.size() + kH5ChunkValues - 1) / kH5ChunkValues);
  parallel_for(packed.size(), [&](std::size_t i) {
    const std::size_t begin = i * kH5ChunkValues;
    packed[i] =
        pack(std::span(batch).subspan(begin, std::min(kH5ChunkValues, batch.size() - begin)), unit,
             offset);
  });
  const H5Lock lock;
  written += batch.size();
  for (std::size_t c = 0; c < columns.size(); ++c) {
    columns[c].extend(written);
    for (const PackedChunk& chunk : packed) columns[c].append(chunk.columns[c]);
  }
}

/// Extends ms_to_idx by the batch, which follows what is written.
void EventH5Writer::State::index() {
  if (written == 0 && !batch.empty()) offset = time_origin_ns(batch.front().t_ns) / unit;
  for (std::size_t i = 0; i < batch.size(); ++i) {
    const std::int64_t tick = in_ticks(batch[i].t_ns, unit) - offset;
    if (tick > kMaxIndexMs * ticks_per_ms)
      throw InputError(target.target().string(),
                       "the events span more than 18 hours; is a time wrong?");
    while (static_cast<std::int64_t>(ms_to_idx.size()) * ticks_per_ms <= tick)
      ms_to_idx.push_back(written + i);
  }
}

void EventH5Writer::State::finish() {
  pending.finish();
  while (!pending.complete().empty()) hand_over();
  writing.wait();
  const H5Lock lock;
  H5Column index_column(file, "ms_to_idx", H5T_STD_U64LE, target.target());
  index_column.extend(ms_to_idx.size());
  check(H5Dwrite(index_column.id(), H5T_NATIVE_UINT64, H5S_ALL, H5S_ALL, H5P_DEFAULT,
                 ms_to_idx.data()) >= 0);
  const H5Handle scalar = {H5Screate(H5S_SCALAR), H5Sclose};
  const H5Handle layout = {H5Pcreate(H5P_DATASET_CREATE), H5Pclose};
  H5Pset_obj_track_times(layout, false);
  H5Handle offset_dataset = {
      H5Dcreate2(file, "t_offset", H5T_STD_I64LE, scalar, H5P_DEFAULT, layout, H5P_DEFAULT),
      H5Dclose};
  check(offset_dataset.valid() &&
        H5Dwrite(offset_dataset, H5T_NATIVE_INT64, H5S_ALL, H5S_ALL, H5P_DEFAULT, &offset) >= 0);
  bool closed = index_column.close() && offset_dataset.close();
  for (H5Column& column : columns) closed = column.close() && closed;
  check(file.close() && closed);
  target.commit();
}

EventH5Writer::EventH5Writer(const std::filesystem::path& file, TimestampUnit unit,
                             SensorSize sensor)
    : state_(std::make_unique<State>(file, unit, sensor)) {}

EventH5Writer::~EventH5Writer() = default;

void EventH5Writer::append(std::span<const Event> events) { state_->add(events); }

void EventH5Writer::close() { state_->finish(); }

std::uint64_t EventH5Writer::count() const { return state_->handed_over + state_->pending.size(); }

}  // namespace saccade
