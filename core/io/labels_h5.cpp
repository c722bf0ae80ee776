#include "core/io/labels_h5.h"

#include <algorithm>
#include <array>
#include <string>
#include <type_traits>

#include "core/check.h"
#include "core/error.h"
#include "core/io/atomic_file.h"
#include "core/io/h5_column.h"
#include "core/parallel.h"

namespace saccade {
namespace {

constexpr std::size_t kChunk = kH5ChunkValues;
constexpr std::size_t kBatch = 16 * kChunk;  // labels, compressed together in parallel

/// Calls use(name, type in the file, type in memory, column) for every column of `labels`.
template <class Labels, class Use>
void for_each_column(Labels& labels, const Use& use) {
  use("depth", H5T_IEEE_F32LE, H5T_NATIVE_FLOAT, labels.depth);
  use("flow_x", H5T_IEEE_F32LE, H5T_NATIVE_FLOAT, labels.flow_x);
  use("flow_y", H5T_IEEE_F32LE, H5T_NATIVE_FLOAT, labels.flow_y);
  use("object", H5T_STD_I32LE, H5T_NATIVE_INT32, labels.object);
  use("origin", H5T_STD_U8LE, H5T_NATIVE_UINT8, labels.origin);
}

constexpr std::size_t kColumns = 5;

using PackedLabels = std::array<H5Chunk, kColumns>;

/// One chunk, padded to its whole size with zeros.
PackedLabels pack(const EventLabels& labels, std::size_t begin) {
  PackedLabels packed;
  std::size_t c = 0;
  for_each_column(labels, [&](const char*, hid_t, hid_t, const auto& column) {
    const std::size_t count = std::min(kChunk, column.size() - begin);
    const auto from = column.begin() + static_cast<std::ptrdiff_t>(begin);
    auto values = std::decay_t<decltype(column)>(from, from + static_cast<std::ptrdiff_t>(count));
    values.resize(kChunk);
    packed[c++] = pack_h5_chunk(values);
  });
  return packed;
}

/// The column `path` of a file; it must hold `count` values.
H5Handle open_column(hid_t file, const std::string& path, const std::string& place,
                     std::uint64_t count) {
  const bool is_there =
      H5Lexists(file, "labels", H5P_DEFAULT) > 0 && H5Lexists(file, path.c_str(), H5P_DEFAULT) > 0;
  if (!is_there) throw InputError(place, "the dataset is missing");
  H5Handle dataset = {H5Dopen2(file, path.c_str(), H5P_DEFAULT), H5Dclose};
  const H5Handle space = {H5Dget_space(dataset), H5Sclose};
  const auto length = H5Sget_simple_extent_npoints(space);
  if (H5Sget_simple_extent_ndims(space) != 1 || static_cast<std::uint64_t>(length) != count)
    throw InputError(place, "has " + std::to_string(length) + " entries for " +
                                std::to_string(count) + " events");
  return dataset;
}

/// Fills `values` from the column's entry `begin` on.
template <class T>
void read_values(hid_t dataset, const std::string& place, hsize_t begin, hid_t type,
                 std::vector<T>& values) {
  const hsize_t size = values.size();
  const H5Handle space = {H5Dget_space(dataset), H5Sclose};
  const H5Handle memory = {H5Screate_simple(1, &size, nullptr), H5Sclose};
  H5Sselect_hyperslab(space, H5S_SELECT_SET, &begin, nullptr, &size, nullptr);
  if (H5Dread(dataset, type, memory, space, H5P_DEFAULT, values.data()) < 0)
    throw InputError(place, "cannot be read (HDF5: " + h5_reason() + ")");
}

}  // namespace

void EventLabels::resize(std::size_t count) {
  for_each_column(*this, [&](const char*, hid_t, hid_t, auto& column) { column.resize(count); });
}

struct LabelsH5Writer::State {
  explicit State(const std::filesystem::path& name) : target(name) {
    const H5Lock lock;
    file = {H5Fcreate(target.path().c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT), H5Fclose};
    check_h5_write(file.valid(), target.target());
    const H5Handle group = {H5Gcreate2(file, "labels", H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT),
                            H5Gclose};
    std::size_t c = 0;
    for_each_column(pending, [&](const char* column, hid_t type, hid_t, const auto&) {
      columns[c++] = {group, column, type, target.target()};
    });
  }

  /// Writes the first `count` pending labels: whole chunks, or everything at the end.
  void write(std::size_t count) {
    std::vector<PackedLabels> packed((count + kChunk - 1) / kChunk);
    parallel_for(packed.size(), [&](std::size_t i) { packed[i] = pack(pending, i * kChunk); });
    const H5Lock lock;
    written += count;
    for (std::size_t c = 0; c < kColumns; ++c) {
      columns[c].extend(written);
      for (const PackedLabels& chunk : packed) columns[c].append(chunk[c]);
    }
    for_each_column(pending, [&](const char*, hid_t, hid_t, auto& column) {
      column.erase(column.begin(), column.begin() + static_cast<std::ptrdiff_t>(count));
    });
  }

  AtomicFile target;
  H5Handle file;
  std::array<H5Column, kColumns> columns;
  EventLabels pending;  ///< not yet written
  std::size_t written = 0;
};

LabelsH5Writer::LabelsH5Writer(const std::filesystem::path& file)
    : state_(std::make_unique<State>(file)) {}

LabelsH5Writer::~LabelsH5Writer() = default;

void LabelsH5Writer::append(const EventLabels& labels) {
  EventLabels& pending = state_->pending;
  const auto add = [&](auto& to, const auto& from) {
    SACCADE_CHECK(from.size() == labels.size());
    to.insert(to.end(), from.begin(), from.end());
  };
  add(pending.depth, labels.depth);
  add(pending.flow_x, labels.flow_x);
  add(pending.flow_y, labels.flow_y);
  add(pending.object, labels.object);
  add(pending.origin, labels.origin);
  if (pending.size() >= kBatch) state_->write(pending.size() / kChunk * kChunk);
}

void LabelsH5Writer::close() {
  if (state_->pending.size() > 0) state_->write(state_->pending.size());
  const H5Lock lock;
  bool closed = true;
  for (H5Column& column : state_->columns) closed = column.close() && closed;
  check_h5_write(state_->file.close() && closed, state_->target.target());
  state_->target.commit();
}

EventLabels read_labels_h5(const std::filesystem::path& name, std::uint64_t count,
                           std::uint64_t begin, std::uint64_t end) {
  SACCADE_CHECK(begin <= end && end <= count);
  const H5Lock lock;
  if (!std::filesystem::exists(name)) throw InputError(name.string(), "no such file");
  const H5Handle access = {H5Pcreate(H5P_FILE_ACCESS), H5Pclose};
  H5Pset_file_locking(access, false, true);  // read-only media and parallel readers
  const H5Handle file = {H5Fopen(name.c_str(), H5F_ACC_RDONLY, access), H5Fclose};
  if (!file.valid())
    throw InputError(name.string(), "is no HDF5 file, or is damaged (HDF5: " + h5_reason() + ")");
  EventLabels labels;
  labels.resize(end - begin);
  for_each_column(labels, [&](const char* column, hid_t, hid_t type, auto& values) {
    const std::string path = std::string("/labels/") + column;
    const std::string place = name.string() + ":" + path;
    const H5Handle dataset = open_column(file, path, place, count);
    if (!values.empty()) read_values(dataset, place, begin, type, values);
  });
  return labels;
}

}  // namespace saccade
