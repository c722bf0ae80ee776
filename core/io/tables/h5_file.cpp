#include "core/io/tables/h5_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <fstream>
#include <string_view>

#include "core/error.h"
#include "core/io/tables/h5_trial.h"

namespace saccade {

H5Handle open_h5_file(const std::filesystem::path& file) {
  if (!std::filesystem::exists(file)) throw InputError(file.string(), "no such file");
  try_h5_file(file);
  const H5Lock lock;
  const H5Handle access = {H5Pcreate(H5P_FILE_ACCESS), H5Pclose};
  H5Pset_file_locking(access, false, true);  // read-only media and parallel readers
  H5Handle opened = {H5Fopen(file.c_str(), H5F_ACC_RDONLY, access), H5Fclose};
  if (!opened.valid())
    throw InputError(file.string(),
                     "is no HDF5 file, or is truncated or damaged (HDF5: " + h5_reason() + ")");
  return opened;
}

H5File::H5File(const std::filesystem::path& file)
    : name_(file.string()), file_(open_h5_file(file)) {}

void H5File::fail(const std::string& path, const std::string& problem) const {
  throw InputError(location(path), problem);
}

void H5File::fail_to_read(const std::string& path, hid_t dataset) const {
  const std::string reason = h5_reason();  // before the hint, which asks HDF5 other things
  fail(path, "cannot be read (HDF5: " + reason + ")" + h5_filter_hint(dataset));
}

bool H5File::has(const std::string& path) const {
  const H5Lock lock;
  return has_h5_link(file_, path);
}

H5Handle H5File::dataset(const std::string& path) const {
  if (!has_h5_link(file_, path)) fail(path, "the dataset is missing");
  H5Handle dataset = {H5Dopen2(file_, path.c_str(), H5P_DEFAULT), H5Dclose};
  if (!dataset.valid()) fail(path, "is no dataset that can be opened");
  return dataset;
}

std::vector<std::uint64_t> H5File::shape(const std::string& path) const {
  const H5Lock lock;
  const H5Handle set = dataset(path);
  const H5Handle space = {H5Dget_space(set), H5Sclose};
  std::vector<hsize_t> size(
      static_cast<std::size_t>(std::max(H5Sget_simple_extent_ndims(space), 0)));
  if (!size.empty()) H5Sget_simple_extent_dims(space, size.data(), nullptr);
  return {size.begin(), size.end()};
}

std::vector<double> H5File::numbers(const std::string& path) const {
  const H5Lock lock;
  const H5Handle set = dataset(path);
  const H5Handle type = {H5Dget_type(set), H5Tclose};
  if (H5Tget_class(type) != H5T_INTEGER && H5Tget_class(type) != H5T_FLOAT)
    fail(path, "must hold numbers");
  const H5Handle space = {H5Dget_space(set), H5Sclose};
  check_h5_size(set, location(path));
  std::vector<double> values(static_cast<std::size_t>(H5Sget_simple_extent_npoints(space)));
  if (!values.empty() &&
      H5Dread(set, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()) < 0)
    fail_to_read(path, set);
  return values;
}

std::string H5File::text(const std::string& path) const {
  const H5Lock lock;
  const H5Handle set = dataset(path);
  std::optional<std::string> text = read_h5_text(set);
  if (!text) fail(path, "must be a single text");
  return *std::move(text);
}

template <class T>
std::vector<T> H5File::slice(const std::string& path, std::uint64_t index, hid_t type) const {
  std::vector<std::uint64_t> lengths = shape(path);
  if (lengths.empty() || index >= lengths[0]) fail(path, fmt::format("has no part {}", index));
  const H5Lock lock;
  const H5Handle set = dataset(path);
  std::vector<hsize_t> start(lengths.size(), 0);
  std::vector<hsize_t> size(lengths.begin(), lengths.end());
  start[0] = index;
  size[0] = 1;
  hsize_t count = 1;
  for (const hsize_t length : size) count *= length;
  check_h5_size(set, location(path));
  std::vector<T> values(count);
  const H5Handle space = {H5Dget_space(set), H5Sclose};
  const H5Handle memory = {H5Screate_simple(1, &count, nullptr), H5Sclose};
  H5Sselect_hyperslab(space, H5S_SELECT_SET, start.data(), nullptr, size.data(), nullptr);
  if (H5Dread(set, type, memory, space, H5P_DEFAULT, values.data()) < 0)
    fail_to_read(fmt::format("{}[{}]", path, index), set);
  return values;
}

std::vector<float> H5File::floats_at(const std::string& path, std::uint64_t index) const {
  return slice<float>(path, index, H5T_NATIVE_FLOAT);
}

std::vector<std::uint8_t> H5File::bytes_at(const std::string& path, std::uint64_t index) const {
  return slice<std::uint8_t>(path, index, H5T_NATIVE_UINT8);
}

void check_h5_size(hid_t dataset, const std::string& location) {
  // What deflate makes of one byte at most, of whose filters it packs tightest, and what needs no proof.
  constexpr double kMostInflation = 1032;
  constexpr double kAlwaysAllowed = 1 << 26;
  const H5Handle space = {H5Dget_space(dataset), H5Sclose};
  const H5Handle type = {H5Dget_type(dataset), H5Tclose};
  const hssize_t count = H5Sget_simple_extent_npoints(space);
  if (count < 0) throw InputError(location, "has no size (HDF5: " + h5_reason() + ")");
  const double claimed = static_cast<double>(count) * static_cast<double>(H5Tget_size(type));
  const auto stored = static_cast<double>(H5Dget_storage_size(dataset));
  if (claimed > kAlwaysAllowed + kMostInflation * stored)
    throw InputError(location,
                     fmt::format("claims {:.0f} bytes, but takes {:.0f} in the file, which "
                                 "cannot hold so many: the file is damaged or cut off",
                                 claimed, stored));
}

namespace {

/// `read(type, memory)` reads what has `space` and `type`, of which a single text is let through alone.
template <class Read>
std::optional<std::string> single_text(const H5Handle& space, const H5Handle& type,
                                       const Read& read) {
  constexpr std::size_t kMostBytes = std::size_t{1} << 20U;
  if (!space.valid() || H5Sget_simple_extent_npoints(space) != 1 ||
      H5Tget_class(type) != H5T_STRING)
    return std::nullopt;
  std::string text;
  if (H5Tis_variable_str(type) > 0) {
    char* value = nullptr;
    if (read(type, &value) && value != nullptr) text = value;
    if (value != nullptr) H5free_memory(value);
    return text;
  }
  if (H5Tget_size(type) > kMostBytes) return std::nullopt;
  text.resize(H5Tget_size(type));
  if (!read(type, text.data())) text.clear();
  return text.c_str();  // without padding
}

}  // namespace

std::optional<std::string> read_h5_text(hid_t dataset) {
  return single_text({H5Dget_space(dataset), H5Sclose}, {H5Dget_type(dataset), H5Tclose},
                     [dataset](hid_t type, void* memory) {
                       return H5Dread(dataset, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, memory) >= 0;
                     });
}

std::optional<std::string> read_h5_text_attribute(hid_t attribute) {
  return single_text(
      {H5Aget_space(attribute), H5Sclose}, {H5Aget_type(attribute), H5Tclose},
      [attribute](hid_t type, void* memory) { return H5Aread(attribute, type, memory) >= 0; });
}

std::string h5_filter_hint(hid_t dataset) {
  struct Hint {
    H5Z_filter_t filter;
    const char* text;
  };
  constexpr Hint kHints[] = {
      {32000, "LZF, in the Debian package hdf5-plugin-lzf"},
      {32001, "Blosc, in the Debian package hdf5-filter-plugin-blosc-serial"},
      {32004, "LZ4, in the Debian package hdf5-filter-plugin"},
      {32008, "Bitshuffle, in the Debian package hdf5-filter-plugin"},
      {0x8ECF,
       "Prophesee's ECF, which no Debian package has: build the plug-in of "
       "github.com/prophesee-ai/hdf5_ecf and name its folder in HDF5_PLUGIN_PATH, or convert "
       "the file to RAW with Prophesee's tools"},
  };
  const H5Handle layout = {H5Dget_create_plist(dataset), H5Pclose};
  for (int i = 0; i < H5Pget_nfilters(layout); ++i) {
    unsigned flags = 0;
    std::size_t values = 0;
    const H5Z_filter_t filter = H5Pget_filter2(layout, static_cast<unsigned>(i), &flags, &values,
                                               nullptr, 0, nullptr, nullptr);
    for (const Hint& hint : kHints)
      if (hint.filter == filter && H5Zfilter_avail(filter) <= 0)
        return fmt::format("; the filter is {}", hint.text);
  }
  return "";
}

bool is_hdf5(const std::filesystem::path& file) {
  constexpr std::string_view kMagic = "\x89HDF\r\n\x1a\n";
  std::array<char, kMagic.size()> head{};
  std::ifstream stream(file, std::ios::binary);
  stream.read(head.data(), head.size());
  return std::string_view(head.data(), static_cast<std::size_t>(stream.gcount())) == kMagic;
}

bool has_h5_link(hid_t file, const std::string& path) {
  // Every group on the way must be there before it may be asked for what is in it.
  for (std::size_t end = path.find('/', 1); end != std::string::npos; end = path.find('/', end + 1))
    if (H5Lexists(file, path.substr(0, end).c_str(), H5P_DEFAULT) <= 0) return false;
  return path == "/" || H5Lexists(file, path.c_str(), H5P_DEFAULT) > 0;
}

}  // namespace saccade
