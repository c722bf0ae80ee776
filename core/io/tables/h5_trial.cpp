#include "core/io/tables/h5_trial.h"

#include <hdf5.h>
#include <sys/stat.h>

#include <array>
#include <cstdint>
#include <mutex>
#include <set>
#include <string>
#include <tuple>
#include <vector>

#include "core/error.h"
#include "core/io/tables/h5_handle.h"
#include "core/process/forked_call.h"

namespace saccade {
namespace {

/// A sound file of a hundred datasets takes milliseconds; in one of 100 GB a million parts are looked up,
/// a few microseconds each.
constexpr ForkLimits kTrialLimits{.cpu_s = 8, .wall_s = 120, .memory_mb = 2048};

/// What is read whole. Of what is larger the first and the last value show the two ways to its parts.
constexpr std::uint64_t kMostBytes = std::uint64_t{1} << 20U;
/// The same of what lies in chunks, which must be unpacked for that.
constexpr std::uint64_t kMostPackedBytes = std::uint64_t{1} << 16U;
/// Of a chunk; HDF5 itself takes none of more than 4 GB.
constexpr hsize_t kMostChunkBytes = hsize_t{1} << 28U;

/// Neither H5Lock nor H5Handle: the thread that held the lock when the process was copied is none of
/// its own. The end of the process closes everything.
namespace trial {

bool is_number(H5T_class_t kind) { return kind == H5T_INTEGER || kind == H5T_FLOAT; }

std::uint64_t bytes_of(hid_t space, hid_t type) {
  const hssize_t count = H5Sget_simple_extent_npoints(space);
  const std::size_t width = H5Tget_size(type);
  if (count <= 0 || width == 0) return 0;
  const auto values = static_cast<std::uint64_t>(count);
  return values > kMostBytes || width > kMostBytes ? kMostBytes + 1 : values * width;
}

herr_t read_attribute(hid_t object, const char* name, const H5A_info_t* /*info*/, void* /*data*/) {
  const hid_t attribute = H5Aopen(object, name, H5P_DEFAULT);
  if (attribute < 0) return 0;
  const hid_t space = H5Aget_space(attribute);
  const hid_t type = H5Aget_type(attribute);
  const std::uint64_t bytes = bytes_of(space, type);
  const H5T_class_t kind = H5Tget_class(type);
  if (bytes > 0 && bytes <= kMostBytes && (is_number(kind) || kind == H5T_STRING)) {
    std::vector<char> memory(bytes + sizeof(char*));
    H5Aread(attribute, type, memory.data());
  }
  return 0;
}

/// The first or the last chunk as it lies in the file: unpacking it is not HDF5's work, and sound for long.
void read_chunk(hid_t dataset, hid_t space, hid_t layout, bool is_last) {
  std::array<hsize_t, H5S_MAX_RANK> lengths{}, chunk{}, start{};
  const int dimensions = H5Sget_simple_extent_ndims(space);
  if (dimensions < 1 || H5Pget_chunk(layout, H5S_MAX_RANK, chunk.data()) != dimensions) return;
  H5Sget_simple_extent_dims(space, lengths.data(), nullptr);
  for (std::size_t i = 0; i < static_cast<std::size_t>(dimensions); ++i) {
    if (lengths[i] == 0 || chunk[i] == 0) return;
    if (is_last) start[i] = (lengths[i] - 1) / chunk[i] * chunk[i];
  }
  hsize_t size = 0;
  if (H5Dget_chunk_storage_size(dataset, start.data(), &size) < 0 || size > kMostChunkBytes) return;
  std::vector<char> memory(size + 1);
  std::uint32_t skipped_filters = 0;
  H5Dread_chunk(dataset, H5P_DEFAULT, start.data(), &skipped_filters, memory.data());
}

/// One value, whose index along each dimension is the first or the last.
void read_value(hid_t dataset, hid_t space, hid_t type, bool is_last) {
  std::array<hsize_t, H5S_MAX_RANK> lengths{}, start{}, count{};
  const int dimensions = H5Sget_simple_extent_ndims(space);
  if (dimensions < 1 || dimensions > H5S_MAX_RANK) return;
  H5Sget_simple_extent_dims(space, lengths.data(), nullptr);
  for (std::size_t i = 0; i < static_cast<std::size_t>(dimensions); ++i) {
    if (lengths[i] == 0) return;
    start[i] = is_last ? lengths[i] - 1 : 0;
    count[i] = 1;
  }
  const hsize_t one = 1;
  const hid_t memory = H5Screate_simple(1, &one, nullptr);
  H5Sselect_hyperslab(space, H5S_SELECT_SET, start.data(), nullptr, count.data(), nullptr);
  std::vector<char> value(H5Tget_size(type));
  H5Dread(dataset, type, memory, space, H5P_DEFAULT, value.data());
}

void read_dataset(hid_t dataset) {
  const hid_t space = H5Dget_space(dataset);
  const hid_t type = H5Dget_type(dataset);
  const hid_t layout = H5Dget_create_plist(dataset);
  H5Dget_storage_size(dataset);  // goes through all chunks
  const bool is_chunked = H5Pget_layout(layout) == H5D_CHUNKED;
  const H5T_class_t kind = H5Tget_class(type);
  const std::uint64_t bytes = bytes_of(space, type);
  if (bytes == 0) return;
  if (bytes <= (is_chunked ? kMostPackedBytes : kMostBytes) &&
      (is_number(kind) || kind == H5T_STRING)) {
    std::vector<char> memory(bytes + sizeof(char*));
    H5Dread(dataset, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, memory.data());
  } else if (is_chunked) {
    for (const bool is_last : {false, true}) read_chunk(dataset, space, layout, is_last);
  } else if (is_number(kind)) {
    for (const bool is_last : {false, true}) read_value(dataset, space, type, is_last);
  }
}

herr_t visit_link(hid_t group, const char* name, const H5L_info_t* link, void* visited);

void visit_object(hid_t object, std::set<haddr_t>& visited) {
  H5O_info_t info{};
  if (H5Oget_info2(object, &info, H5O_INFO_BASIC) < 0 || !visited.insert(info.addr).second) return;
  H5Aiterate2(object, H5_INDEX_NAME, H5_ITER_NATIVE, nullptr, read_attribute, nullptr);
  if (info.type == H5O_TYPE_DATASET) read_dataset(object);
  if (info.type == H5O_TYPE_GROUP)
    H5Literate(object, H5_INDEX_NAME, H5_ITER_NATIVE, nullptr, visit_link, &visited);
}

/// Goes on where an object cannot be opened, which H5Ovisit() does not.
herr_t visit_link(hid_t group, const char* name, const H5L_info_t* link, void* visited) {
  const hid_t object = link->type == H5L_TYPE_HARD ? H5Oopen(group, name, H5P_DEFAULT) : -1;
  if (object >= 0) visit_object(object, *static_cast<std::set<haddr_t>*>(visited));
  return 0;
}

void read_all(const std::string& name) {
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
  const hid_t access = H5Pcreate(H5P_FILE_ACCESS);
  H5Pset_file_locking(access, false, true);
  const hid_t file = H5Fopen(name.c_str(), H5F_ACC_RDONLY, access);
  const hid_t root = H5Oopen(file, "/", H5P_DEFAULT);
  std::set<haddr_t> visited;
  if (root >= 0) visit_object(root, visited);
}

}  // namespace trial

using Version = std::tuple<dev_t, ino_t, off_t, std::int64_t, std::int64_t>;

Version version_of(const std::filesystem::path& file) {
  struct stat status {};
  ::stat(file.c_str(), &status);
  return {status.st_dev, status.st_ino, status.st_size, status.st_mtim.tv_sec,
          status.st_mtim.tv_nsec};
}

}  // namespace

void try_h5_file(const std::filesystem::path& file) {
  static std::mutex mutex;
  static std::set<Version> tried;
  const Version version = version_of(file);
  {
    const std::lock_guard lock(mutex);
    if (tried.contains(version)) return;
  }
  const ForkedResult result = [&] {
    const H5Lock lock;  // no other thread is amid a call whose traces the copy would see
    return call_in_child(
        [&] {
          trial::read_all(file.string());
          return std::string();
        },
        kTrialLimits);
  }();
  if (result.died)
    throw InputError(file.string(),
                     "is damaged in a way that HDF5 does not survive: it " + result.problem);
  const std::lock_guard lock(mutex);
  tried.insert(version);
}

}  // namespace saccade
