#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <vector>

#include "core/io/tables/h5_handle.h"

namespace saccade {

/// Values in a chunk; also the grain of windowed reading.
constexpr std::size_t kH5ChunkValues = std::size_t{1} << 16;

/// Values that are gathered before their chunks are compressed, together in parallel.
constexpr std::size_t kH5BatchValues = 16 * kH5ChunkValues;

/// InputError for `file` with HDF5's own reason, unless `success`.
void check_h5_write(bool success, const std::filesystem::path& file);

/// The values of one chunk as HDF5's shuffle and deflate (level 1) filters store them, so that
/// chunks can be packed in parallel. The last chunk of a column is packed whole, too.
using H5Chunk = std::vector<std::byte>;
[[nodiscard]] H5Chunk pack_h5_chunk(std::span<const std::byte> values, std::size_t value_bytes);

template <class T>
[[nodiscard]] H5Chunk pack_h5_chunk(const std::vector<T>& values) {
  return pack_h5_chunk(std::as_bytes(std::span(values)), sizeof(T));
}

/// A growing one-dimensional dataset of a file that is being written. The same values give the same
/// bytes. Hold an H5Lock.
class H5Column {
 public:
  H5Column() = default;
  H5Column(hid_t parent, const char* name, hid_t type, const std::filesystem::path& file);

  /// Room for `count` values in all.
  void extend(std::size_t count);
  /// The next chunk, within the room.
  void append(const H5Chunk& chunk);
  [[nodiscard]] bool close() { return dataset_.close(); }
  [[nodiscard]] hid_t id() const { return dataset_; }

 private:
  std::filesystem::path file_;
  H5Handle dataset_;
  hsize_t chunks_ = 0;
};

}  // namespace saccade
