#include <zlib.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <string>
#include <vector>

#include "core/check.h"
#include "core/error.h"
#include "core/io/atomic_file.h"
#include "core/io/events_h5.h"
#include "core/io/h5_handle.h"
#include "core/parallel.h"

namespace saccade {
namespace {

constexpr std::size_t kChunk = std::size_t{1} << 16;  // events; also the grain of windowed reading
constexpr std::size_t kBatch = 16 * kChunk;           // compressed together, in parallel
constexpr int kDeflateLevel = 1;
constexpr std::int64_t kMaxIndexMs = std::int64_t{1} << 31;

/// HDF5's shuffle filter: the first bytes of all values, then the second ones ...
std::vector<unsigned char> shuffled(const unsigned char* values, std::size_t count,
                                    std::size_t width) {
  std::vector<unsigned char> bytes(count * width);
  for (std::size_t b = 0; b < width; ++b) {
    unsigned char* plane = bytes.data() + b * count;
    for (std::size_t i = 0; i < count; ++i) plane[i] = values[i * width + b];
  }
  return bytes;
}

/// One chunk as HDF5's shuffle and deflate filters would store it.
template <class T>
std::vector<unsigned char> pack_chunk(const std::vector<T>& values) {
  const auto* raw = reinterpret_cast<const unsigned char*>(values.data());
  const std::vector<unsigned char> bytes = shuffled(raw, values.size(), sizeof(T));
  uLongf size = compressBound(bytes.size());
  std::vector<unsigned char> packed(size);
  SACCADE_CHECK(compress2(packed.data(), &size, bytes.data(), bytes.size(), kDeflateLevel) == Z_OK);
  packed.resize(size);
  return packed;
}

/// A growing one-dimensional dataset whose chunks come packed.
struct Column {
  H5Handle dataset;
  hsize_t chunks = 0;
};

struct PackedChunk {
  std::array<std::vector<unsigned char>, 4> columns;  ///< x, y, p, t
};

PackedChunk pack(std::span<const Event> events, TimeNs unit, TimeNs offset) {
  std::vector<std::uint16_t> x(kChunk);
  std::vector<std::uint16_t> y(kChunk);
  std::vector<std::uint8_t> p(kChunk);
  std::vector<std::int64_t> t(kChunk);
  for (std::size_t i = 0; i < events.size(); ++i) {
    x[i] = events[i].x;
    y[i] = events[i].y;
    p[i] = events[i].polarity > 0 ? 1 : 0;
    t[i] = events[i].t_ns / unit - offset;
  }
  return {{pack_chunk(x), pack_chunk(y), pack_chunk(p), pack_chunk(t)}};
}

std::int64_t floor_div(std::int64_t a, std::int64_t b) {
  return a / b - static_cast<std::int64_t>(a % b < 0);
}

}  // namespace

struct EventH5Writer::State {
  State(const std::filesystem::path& file_name, TimestampUnit timestamp_unit)
      : target(file_name),
        unit(timestamp_unit == TimestampUnit::kMicroseconds ? 1000 : 1),
        ticks_per_ms(1'000'000 / unit) {
    const H5Lock lock;
    file = {H5Fcreate(target.path().c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT), H5Fclose};
    check(file.valid());
    const H5Handle group = {H5Gcreate2(file, "events", H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT),
                            H5Gclose};
    columns[0].dataset = create(group, "x", H5T_STD_U16LE, kChunk);
    columns[1].dataset = create(group, "y", H5T_STD_U16LE, kChunk);
    columns[2].dataset = create(group, "p", H5T_STD_U8LE, kChunk);
    columns[3].dataset = create(group, "t", H5T_STD_I64LE, kChunk);
    write_unit(columns[3].dataset);
  }

  void check(bool success) const {
    if (success) return;
    const std::string reason = h5_reason();
    throw InputError(
        target.target().string(),
        "cannot be written" + (reason.empty() ? "; is the disk full?" : " (HDF5: " + reason + ")"));
  }

  H5Handle create(hid_t parent, const char* name, hid_t type, hsize_t chunk) const {
    const hsize_t none = 0;
    const hsize_t unlimited = H5S_UNLIMITED;
    const H5Handle space = {H5Screate_simple(1, &none, &unlimited), H5Sclose};
    const H5Handle layout = {H5Pcreate(H5P_DATASET_CREATE), H5Pclose};
    H5Pset_chunk(layout, 1, &chunk);
    H5Pset_shuffle(layout);
    H5Pset_deflate(layout, kDeflateLevel);
    H5Pset_obj_track_times(layout, false);  // the same events give the same bytes
    H5Handle dataset = {H5Dcreate2(parent, name, type, space, H5P_DEFAULT, layout, H5P_DEFAULT),
                        H5Dclose};
    check(dataset.valid());
    return dataset;
  }

  void write_unit(hid_t dataset) const {
    const H5Handle type = {H5Tcopy(H5T_C_S1), H5Tclose};
    H5Tset_size(type, 2);
    const H5Handle space = {H5Screate(H5S_SCALAR), H5Sclose};
    const H5Handle attribute = {H5Acreate2(dataset, "unit", type, space, H5P_DEFAULT, H5P_DEFAULT),
                                H5Aclose};
    check(attribute.valid() && H5Awrite(attribute, type, unit == 1 ? "ns" : "us") >= 0);
  }

  void add(std::span<const Event> events);
  void write_chunks(std::size_t end);
  void index(std::span<const Event> events);
  void finish();

  AtomicFile target;
  TimeNs unit;  ///< [ns]
  std::int64_t ticks_per_ms;
  H5Handle file;
  std::array<Column, 4> columns;
  std::vector<Event> pending;  ///< not yet written, times rounded to the unit
  std::size_t open_ties = 0;   ///< where the last run of equal times begins in `pending`
  std::int64_t offset = 0;     ///< /t_offset [ticks]
  std::uint64_t written = 0;
  TimeNs last = std::numeric_limits<TimeNs>::min();  ///< before rounding
  std::vector<std::uint64_t> ms_to_idx;
};

void EventH5Writer::State::add(std::span<const Event> events) {
  for (Event event : events) {
    SACCADE_CHECK(event.t_ns >= last);
    last = event.t_ns;
    event.t_ns = floor_div(event.t_ns + unit / 2, unit) * unit;
    if (pending.empty() || pending.back().t_ns != event.t_ns) {
      sort_ties(std::span(pending).subspan(open_ties));
      // Only complete runs of ties are written: a later event may still belong before the others.
      if (pending.size() >= kBatch) write_chunks(pending.size());
      open_ties = pending.size();
    }
    pending.push_back(event);
  }
}

/// Writes the whole chunks among the first `end` pending events.
void EventH5Writer::State::write_chunks(std::size_t end) {
  const std::size_t count = end / kChunk * kChunk;
  const std::span<const Event> events = std::span(pending).first(count);
  index(events);
  std::vector<PackedChunk> packed(count / kChunk);
  parallel_for(packed.size(), [&](std::size_t i) {
    packed[i] = pack(events.subspan(i * kChunk, kChunk), unit, offset);
  });
  const H5Lock lock;
  for (std::size_t c = 0; c < columns.size(); ++c) {
    const hsize_t size = written + count;
    check(H5Dset_extent(columns[c].dataset, &size) >= 0);
    for (const PackedChunk& chunk : packed) {
      const hsize_t position = columns[c].chunks++ * kChunk;
      const std::vector<unsigned char>& bytes = chunk.columns[c];
      check(H5Dwrite_chunk(columns[c].dataset, H5P_DEFAULT, 0, &position, bytes.size(),
                           bytes.data()) >= 0);
    }
  }
  written += count;
  pending.erase(pending.begin(), pending.begin() + static_cast<std::ptrdiff_t>(count));
}

/// Extends ms_to_idx by events that follow those written.
void EventH5Writer::State::index(std::span<const Event> events) {
  if (written == 0 && !events.empty()) {
    constexpr std::int64_t kHourNs = 3'600'000'000'000;
    const TimeNs first = events.front().t_ns;
    if (first < 0 || first > kHourNs)
      offset = floor_div(first, 1'000'000'000) * ticks_per_ms * 1000;
  }
  for (std::size_t i = 0; i < events.size(); ++i) {
    const std::int64_t ms = (events[i].t_ns / unit - offset) / ticks_per_ms;
    if (ms > kMaxIndexMs)
      throw InputError(target.target().string(),
                       "the events span more than 24 days; is a time wrong?");
    while (static_cast<std::int64_t>(ms_to_idx.size()) <= ms) ms_to_idx.push_back(written + i);
  }
}

void EventH5Writer::State::finish() {
  sort_ties(std::span(pending).subspan(open_ties));
  write_chunks(pending.size());
  index(pending);
  const H5Lock lock;
  if (!pending.empty()) {
    const PackedChunk chunk = pack(pending, unit, offset);  // padded to the chunk's size
    const hsize_t size = written + pending.size();
    for (std::size_t c = 0; c < columns.size(); ++c) {
      const hsize_t position = columns[c].chunks * kChunk;
      const std::vector<unsigned char>& bytes = chunk.columns[c];
      check(H5Dset_extent(columns[c].dataset, &size) >= 0);
      check(H5Dwrite_chunk(columns[c].dataset, H5P_DEFAULT, 0, &position, bytes.size(),
                           bytes.data()) >= 0);
    }
    written = size;
    pending.clear();
  }
  H5Handle index_dataset = create(file, "ms_to_idx", H5T_STD_U64LE, kChunk);
  const hsize_t length = ms_to_idx.size();
  check(H5Dset_extent(index_dataset, &length) >= 0);
  check(H5Dwrite(index_dataset, H5T_NATIVE_UINT64, H5S_ALL, H5S_ALL, H5P_DEFAULT,
                 ms_to_idx.data()) >= 0);
  const H5Handle scalar = {H5Screate(H5S_SCALAR), H5Sclose};
  const H5Handle layout = {H5Pcreate(H5P_DATASET_CREATE), H5Pclose};
  H5Pset_obj_track_times(layout, false);
  H5Handle offset_dataset = {
      H5Dcreate2(file, "t_offset", H5T_STD_I64LE, scalar, H5P_DEFAULT, layout, H5P_DEFAULT),
      H5Dclose};
  check(offset_dataset.valid() &&
        H5Dwrite(offset_dataset, H5T_NATIVE_INT64, H5S_ALL, H5S_ALL, H5P_DEFAULT, &offset) >= 0);
  bool closed = index_dataset.close() && offset_dataset.close();
  for (Column& column : columns) closed = column.dataset.close() && closed;
  check(file.close() && closed);
  target.commit();
}

EventH5Writer::EventH5Writer(const std::filesystem::path& file, TimestampUnit unit)
    : state_(std::make_unique<State>(file, unit)) {}

EventH5Writer::~EventH5Writer() = default;

void EventH5Writer::append(std::span<const Event> events) { state_->add(events); }

void EventH5Writer::close() { state_->finish(); }

std::uint64_t EventH5Writer::count() const { return state_->written + state_->pending.size(); }

}  // namespace saccade
