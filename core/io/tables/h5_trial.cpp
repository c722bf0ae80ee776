#include "core/io/tables/h5_trial.h"

#include <hdf5.h>
#include <sys/stat.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <set>
#include <string>
#include <system_error>
#include <tuple>
#include <vector>

#include "core/error.h"
#include "core/io/tables/h5_handle.h"
#include "core/process/forked_call.h"

namespace saccade {
namespace {

/// A sound file of a hundred datasets takes milliseconds. In one of a gigabyte a million parts may have to be
/// looked up, a few microseconds each, or a few milliseconds where one in a hundred is read from a slow disk.
ForkLimits limits_of(std::uint64_t file_bytes) {
  const double gigabytes = 1e-9 * static_cast<double>(file_bytes);
  return {.cpu_s = 8 + 5 * gigabytes, .wall_s = 120 + 60 * gigabytes, .memory_mb = 2048};
}

/// What is read whole. Of what is larger the first and the last value show the two ways to its parts.
constexpr std::uint64_t kMostBytes = std::uint64_t{1} << 20U;
/// The same of what lies in chunks, which must be unpacked for that.
constexpr std::uint64_t kMostPackedBytes = std::uint64_t{1} << 16U;
/// Of a chunk; HDF5 itself takes none of more than 4 GB.
constexpr hsize_t kMostChunkBytes = hsize_t{1} << 28U;

/// Neither H5Lock nor H5Handle, which take a lock that the copy of a process cannot have. Callbacks throw
/// nothing through HDF5: where memory ends, the trial does.
namespace trial {

class Id {
 public:
  using Closer = herr_t (*)(hid_t);
  Id(hid_t id, Closer closer) : id_(id), closer_(closer) {}
  ~Id() {
    if (id_ >= 0) closer_(id_);
  }
  Id(const Id&) = delete;
  Id& operator=(const Id&) = delete;
  operator hid_t() const { return id_; }  // NOLINT: passed to HDF5 as it is

 private:
  hid_t id_;
  Closer closer_;
};

/// Of `count` values of `width` bytes, or more than kMostBytes.
std::uint64_t bytes_of(hssize_t count, std::size_t width) {
  if (count <= 0 || width == 0) return 0;
  const auto values = static_cast<std::uint64_t>(count);
  return values > kMostBytes || width > kMostBytes ? kMostBytes + 1 : values * width;
}

herr_t read_attribute(hid_t object, const char* name, const H5A_info_t* /*info*/,
                      void* /*data*/) noexcept {
  const Id attribute(H5Aopen(object, name, H5P_DEFAULT), H5Aclose);
  if (attribute < 0) return 0;
  const Id space(H5Aget_space(attribute), H5Sclose);
  const Id type(H5Aget_type(attribute), H5Tclose);
  const Id native(H5Tget_native_type(type, H5T_DIR_ASCEND), H5Tclose);
  const std::uint64_t bytes = bytes_of(H5Sget_simple_extent_npoints(space), H5Tget_size(native));
  if (native < 0 || bytes == 0 || bytes > kMostBytes) return 0;
  std::vector<char> memory(bytes);
  H5Aread(attribute, native, memory.data());
  return 0;
}

/// The first or the last chunk as it lies in the file: what is packed by deflate alone is unpacked by zlib,
/// which is sound.
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
void read_value(hid_t dataset, hid_t space, hid_t native, bool is_last) {
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
  const Id memory(H5Screate_simple(1, &one, nullptr), H5Sclose);
  H5Sselect_hyperslab(space, H5S_SELECT_SET, start.data(), nullptr, count.data(), nullptr);
  std::vector<char> value(H5Tget_size(native));
  H5Dread(dataset, native, memory, space, H5P_DEFAULT, value.data());
}

/// Whether nothing but zlib has to do with what lies in the chunks.
bool is_deflated_alone(hid_t layout) {
  for (int i = 0; i < H5Pget_nfilters(layout); ++i) {
    unsigned flags = 0;
    std::size_t values = 0;
    const H5Z_filter_t filter = H5Pget_filter2(layout, static_cast<unsigned>(i), &flags, &values,
                                               nullptr, 0, nullptr, nullptr);
    if (filter != H5Z_FILTER_DEFLATE && filter != H5Z_FILTER_SHUFFLE) return false;
  }
  return true;
}

void read_dataset(hid_t dataset) {
  const Id space(H5Dget_space(dataset), H5Sclose);
  const Id type(H5Dget_type(dataset), H5Tclose);
  const Id native(H5Tget_native_type(type, H5T_DIR_ASCEND), H5Tclose);
  const Id layout(H5Dget_create_plist(dataset), H5Pclose);
  H5Dget_storage_size(dataset);  // goes through all chunks
  const bool is_chunked = H5Pget_layout(layout) == H5D_CHUNKED;
  const H5T_class_t kind = H5Tget_class(type);
  const std::uint64_t bytes = bytes_of(H5Sget_simple_extent_npoints(space), H5Tget_size(native));
  if (native < 0 || bytes == 0) return;
  if (bytes <= (is_chunked ? kMostPackedBytes : kMostBytes)) {
    std::vector<char> memory(bytes);
    H5Dread(dataset, native, H5S_ALL, H5S_ALL, H5P_DEFAULT, memory.data());
    return;
  }
  const bool is_number = kind == H5T_INTEGER || kind == H5T_FLOAT;
  for (const bool is_last : {false, true})
    if (is_chunked && is_number && is_deflated_alone(layout))
      read_chunk(dataset, space, layout, is_last);
    else
      read_value(dataset, space, native, is_last);
}

herr_t visit_link(hid_t group, const char* name, const H5L_info_t* link, void* visited) noexcept;

void visit_object(hid_t object, std::set<haddr_t>& visited) {
  H5O_info_t info{};
  if (H5Oget_info2(object, &info, H5O_INFO_BASIC) < 0 || !visited.insert(info.addr).second) return;
  H5Aiterate2(object, H5_INDEX_NAME, H5_ITER_NATIVE, nullptr, read_attribute, nullptr);
  if (info.type == H5O_TYPE_DATASET) read_dataset(object);
  if (info.type == H5O_TYPE_GROUP)
    H5Literate(object, H5_INDEX_NAME, H5_ITER_NATIVE, nullptr, visit_link, &visited);
}

/// Goes on where an object cannot be opened, which H5Ovisit() does not.
herr_t visit_link(hid_t group, const char* name, const H5L_info_t* link, void* visited) noexcept {
  if (link->type != H5L_TYPE_HARD) return 0;
  const Id object(H5Oopen(group, name, H5P_DEFAULT), H5Oclose);
  if (object >= 0) visit_object(object, *static_cast<std::set<haddr_t>*>(visited));
  return 0;
}

void read_all(const std::string& name) {
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
  const Id access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose);
  H5Pset_file_locking(access, false, true);
  const Id file(H5Fopen(name.c_str(), H5F_ACC_RDONLY, access), H5Fclose);
  const Id root(H5Oopen(file, "/", H5P_DEFAULT), H5Oclose);
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

/// What is wrong with it; "" where it passes. Hold an H5Lock: no other thread is amid a call then, of which
/// the copy would see half.
std::string problem_of(const std::filesystem::path& file) {
  std::error_code no_size;
  const std::uint64_t size = std::filesystem::file_size(file, no_size);
  const ForkedResult result = call_in_child(
      [&] {
        trial::read_all(file.string());
        return std::string();
      },
      limits_of(no_size ? 0 : size));
  if (result.problem.empty()) return {};
  return result.died ? "is damaged in a way that HDF5 does not survive: it " + result.problem
                     : "cannot be tried in another process: " + result.problem;
}

}  // namespace

void try_h5_file(const std::filesystem::path& file) {
  const H5Lock lock;  // of what was found as well
  static std::map<Version, std::string> problems;
  const Version version = version_of(file);
  auto known = problems.find(version);
  if (known == problems.end()) known = problems.emplace(version, problem_of(file)).first;
  if (!known->second.empty()) throw InputError(file.string(), known->second);
}

}  // namespace saccade
