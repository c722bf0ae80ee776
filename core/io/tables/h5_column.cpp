#include "core/io/tables/h5_column.h"

#include <zlib.h>

#include <string>

#include "core/check.h"
#include "core/error.h"

namespace saccade {
namespace {

constexpr int kDeflateLevel = 1;

/// HDF5's shuffle filter: the first bytes of all values, then the second ones ...
std::vector<unsigned char> shuffled(std::span<const std::byte> values, std::size_t width) {
  const std::size_t count = values.size() / width;
  std::vector<unsigned char> bytes(values.size());
  for (std::size_t b = 0; b < width; ++b) {
    unsigned char* plane = bytes.data() + b * count;
    for (std::size_t i = 0; i < count; ++i)
      plane[i] = std::to_integer<unsigned char>(values[i * width + b]);
  }
  return bytes;
}

}  // namespace

void check_h5_write(bool success, const std::filesystem::path& file) {
  if (success) return;
  const std::string reason = h5_reason();
  throw InputError(file.string(),
                   "cannot be written" + (reason.empty() ? "" : " (HDF5: " + reason + ")") +
                       "; if the disk is full, make room there or write to another place");
}

H5Chunk pack_h5_chunk(std::span<const std::byte> values, std::size_t value_bytes) {
  const std::vector<unsigned char> bytes = shuffled(values, value_bytes);
  uLongf size = compressBound(bytes.size());
  H5Chunk packed(size);
  SACCADE_CHECK(compress2(packed.data(), &size, bytes.data(), bytes.size(), kDeflateLevel) == Z_OK);
  packed.resize(size);
  return packed;
}

H5Column::H5Column(hid_t parent, const char* name, hid_t type, const std::filesystem::path& file)
    : file_(file) {
  const hsize_t none = 0;
  const hsize_t unlimited = H5S_UNLIMITED;
  const hsize_t chunk = kH5ChunkValues;
  const H5Handle space = {H5Screate_simple(1, &none, &unlimited), H5Sclose};
  const H5Handle layout = {H5Pcreate(H5P_DATASET_CREATE), H5Pclose};
  H5Pset_chunk(layout, 1, &chunk);
  H5Pset_shuffle(layout);
  H5Pset_deflate(layout, kDeflateLevel);
  H5Pset_obj_track_times(layout, false);  // the same values give the same bytes
  dataset_ = {H5Dcreate2(parent, name, type, space, H5P_DEFAULT, layout, H5P_DEFAULT), H5Dclose};
  check_h5_write(dataset_.valid(), file_);
}

void H5Column::extend(std::size_t count) {
  const hsize_t size = count;
  check_h5_write(H5Dset_extent(dataset_, &size) >= 0, file_);
}

void H5Column::append(const H5Chunk& chunk) {
  const hsize_t position = chunks_++ * kH5ChunkValues;
  check_h5_write(
      H5Dwrite_chunk(dataset_, H5P_DEFAULT, 0, &position, chunk.size(), chunk.data()) >= 0, file_);
}

}  // namespace saccade
