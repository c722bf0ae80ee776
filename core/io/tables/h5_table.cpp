#include "core/io/tables/h5_table.h"

#include <algorithm>

#include "core/check.h"
#include "core/error.h"
#include "core/io/files/atomic_file.h"
#include "core/io/tables/h5_column.h"
#include "core/io/tables/h5_file.h"
#include "core/process/background_task.h"
#include "core/process/parallel.h"

namespace saccade {
namespace {

std::size_t bytes_of(H5Type type) {
  switch (type) {
    case H5Type::kFloat32:
    case H5Type::kInt32:
      return 4;
    case H5Type::kUint16:
      return 2;
    case H5Type::kUint8:
      return 1;
  }
  return 0;
}

hid_t type_in_file(H5Type type) {
  switch (type) {
    case H5Type::kFloat32:
      return H5T_IEEE_F32LE;
    case H5Type::kInt32:
      return H5T_STD_I32LE;
    case H5Type::kUint16:
      return H5T_STD_U16LE;
    case H5Type::kUint8:
      return H5T_STD_U8LE;
  }
  return -1;
}

hid_t type_in_memory(H5Type type) {
  switch (type) {
    case H5Type::kFloat32:
      return H5T_NATIVE_FLOAT;
    case H5Type::kInt32:
      return H5T_NATIVE_INT32;
    case H5Type::kUint16:
      return H5T_NATIVE_UINT16;
    case H5Type::kUint8:
      return H5T_NATIVE_UINT8;
  }
  return -1;
}

bool has_column(hid_t file, const std::string& group, const std::string& name) {
  return H5Lexists(file, group.c_str(), H5P_DEFAULT) > 0 &&
         H5Lexists(file, (group + "/" + name).c_str(), H5P_DEFAULT) > 0;
}

/// The column `name` of a group; it must hold `count` values.
H5Handle open_column(hid_t file, const std::string& group, const char* name,
                     const std::string& location, std::uint64_t count) {
  const std::string path = group + "/" + name;
  if (!has_column(file, group, name)) throw InputError(location, "the dataset is missing");
  H5Handle dataset = {H5Dopen2(file, path.c_str(), H5P_DEFAULT), H5Dclose};
  const H5Handle space = {H5Dget_space(dataset), H5Sclose};
  if (H5Sget_simple_extent_ndims(space) != 1) throw InputError(location, "must have one dimension");
  const auto length = H5Sget_simple_extent_npoints(space);
  if (H5Sget_simple_extent_ndims(space) != 1 || static_cast<std::uint64_t>(length) != count)
    throw InputError(location, "has " + std::to_string(length) + " entries for " +
                                   std::to_string(count) + " events");
  return dataset;
}

void read_column(hid_t dataset, const std::string& location, std::uint64_t begin,
                 const H5Target& column) {
  const hsize_t first = begin;
  const hsize_t size = column.bytes.size() / bytes_of(column.type);
  const H5Handle space = {H5Dget_space(dataset), H5Sclose};
  const H5Handle memory = {H5Screate_simple(1, &size, nullptr), H5Sclose};
  H5Sselect_hyperslab(space, H5S_SELECT_SET, &first, nullptr, &size, nullptr);
  if (H5Dread(dataset, type_in_memory(column.type), memory, space, H5P_DEFAULT,
              column.bytes.data()) < 0)
    throw InputError(location, "cannot be read (HDF5: " + h5_reason() + ")");
}

}  // namespace

struct H5TableWriter::State {
  struct Column {
    H5Column file;
    std::size_t value_bytes;
    std::vector<std::byte> pending;  ///< not yet handed over
    std::vector<std::byte> batch;    ///< that is being written

    [[nodiscard]] std::size_t rows() const { return pending.size() / value_bytes; }

    /// The chunk of the batch from row `begin` on, padded to its whole size with zeros.
    [[nodiscard]] H5Chunk pack(std::size_t begin) const {
      const std::size_t count = std::min(kH5ChunkValues, batch.size() / value_bytes - begin);
      const auto from = batch.begin() + static_cast<std::ptrdiff_t>(begin * value_bytes);
      std::vector<std::byte> values(from, from + static_cast<std::ptrdiff_t>(count * value_bytes));
      values.resize(kH5ChunkValues * value_bytes);
      return pack_h5_chunk(values, value_bytes);
    }
  };

  State(const std::filesystem::path& name, const char* group_name, std::span<const H5Source> schema)
      : target(name) {
    const H5Lock lock;
    file = {H5Fcreate(target.path().c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT), H5Fclose};
    check_h5_write(file.valid(), target.target());
    const H5Handle group = {H5Gcreate2(file, group_name, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT),
                            H5Gclose};
    for (const H5Source& column : schema)
      columns.push_back({{group, column.name, type_in_file(column.type), target.target()},
                         bytes_of(column.type),
                         {},
                         {}});
  }

  /// Gives the first `count` pending rows, whole chunks, or everything at the end, to be packed and
  /// written beside the caller's work.
  void hand_over(std::size_t count) {
    writing.wait();
    for (Column& column : columns) {
      const auto end =
          column.pending.begin() + static_cast<std::ptrdiff_t>(count * column.value_bytes);
      column.batch.assign(column.pending.begin(), end);
      column.pending.erase(column.pending.begin(), end);
    }
    writing.start([this, count] { write_batch(count); });
  }

  void write_batch(std::size_t count) {
    const std::size_t chunks = (count + kH5ChunkValues - 1) / kH5ChunkValues;
    std::vector<H5Chunk> packed(chunks * columns.size());
    parallel_for(packed.size(), [&](std::size_t i) {
      packed[i] = columns[i / chunks].pack(i % chunks * kH5ChunkValues);
    });
    const H5Lock lock;
    written += count;
    for (std::size_t c = 0; c < columns.size(); ++c) {
      columns[c].file.extend(written);
      for (std::size_t i = 0; i < chunks; ++i) columns[c].file.append(packed[c * chunks + i]);
    }
  }

  AtomicFile target;
  H5Handle file;
  std::vector<Column> columns;
  std::size_t written = 0;
  BackgroundTask writing;  ///< of the batches; last, so that it ends before the rest does
};

H5TableWriter::H5TableWriter(const std::filesystem::path& file, const char* group,
                             std::span<const H5Source> columns)
    : state_(std::make_unique<State>(file, group, columns)) {}

H5TableWriter::~H5TableWriter() = default;

void H5TableWriter::append(std::span<const H5Source> columns) {
  SACCADE_CHECK(columns.size() == state_->columns.size());
  for (std::size_t c = 0; c < columns.size(); ++c) {
    std::vector<std::byte>& pending = state_->columns[c].pending;
    pending.insert(pending.end(), columns[c].bytes.begin(), columns[c].bytes.end());
    SACCADE_CHECK(state_->columns[c].rows() == state_->columns[0].rows());
  }
  const std::size_t rows = state_->columns[0].rows();
  if (rows >= kH5BatchValues) state_->hand_over(rows / kH5ChunkValues * kH5ChunkValues);
}

void H5TableWriter::close() {
  if (const std::size_t rows = state_->columns[0].rows(); rows > 0) state_->hand_over(rows);
  state_->writing.wait();
  const H5Lock lock;
  bool closed = true;
  for (State::Column& column : state_->columns) closed = column.file.close() && closed;
  check_h5_write(state_->file.close() && closed, state_->target.target());
  state_->target.commit();
}

void read_h5_table(const std::filesystem::path& name, const std::string& group, std::uint64_t count,
                   std::uint64_t begin, std::span<const H5Target> columns) {
  const H5Handle file = open_h5_file(name);
  const H5Lock lock;
  for (const H5Target& column : columns) {
    const std::string location = name.string() + ":/" + group + "/" + column.name;
    const H5Handle dataset = open_column(file, group, column.name, location, count);
    if (!column.bytes.empty()) read_column(dataset, location, begin, column);
  }
}

bool has_h5_column(const std::filesystem::path& name, const std::string& group,
                   const std::string& column) {
  if (!is_hdf5(name)) return false;
  const H5Handle file = open_h5_file(name);
  const H5Lock lock;
  return has_column(file, group, column);
}

}  // namespace saccade
