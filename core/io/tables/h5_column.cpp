#include "core/io/tables/h5_column.h"

#include <memory>
#include <string>

#include "core/error.h"
#include "core/io/files/zlib_stream.h"
#include "core/io/tables/h5_chunks.h"

namespace saccade {
namespace {

constexpr int kDeflateLevel = 1;

}  // namespace

void check_h5_write(bool success, const std::filesystem::path& file) {
  if (success) return;
  const std::string reason = h5_reason();
  throw InputError(file.string(),
                   "cannot be written" + (reason.empty() ? "" : " (HDF5: " + reason + ")") +
                       "; if the disk is full, make room there or write to another place");
}

H5Chunk pack_h5_chunk(std::span<const std::byte> values, std::size_t value_bytes) {
  if (value_bytes == 1) return pack_zlib_fast(values);
  const auto memory = std::make_unique_for_overwrite<std::byte[]>(values.size());
  const std::span shuffled(memory.get(), values.size());
  shuffle_bytes(values, value_bytes, shuffled);
  return pack_zlib_fast(shuffled);
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
