#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/io/tables/h5_handle.h"

namespace saccade {

/// Opens a file to be read. InputError where there is none, no HDF5 file, or one that HDF5 does not
/// survive (h5_trial.h).
[[nodiscard]] H5Handle open_h5_file(const std::filesystem::path& file);

/// An HDF5 file whose arrays are read whole or by their first index. InputError with "FILE:/path" for
/// what is missing, of another kind or cannot be read.
class H5File {
 public:
  explicit H5File(const std::filesystem::path& file);

  /// Whether there is a group or a dataset.
  [[nodiscard]] bool has(const std::string& path) const;
  /// Lengths, the slowest index first; none of a single number.
  [[nodiscard]] std::vector<std::uint64_t> shape(const std::string& path) const;
  /// All numbers, in the order of the array.
  [[nodiscard]] std::vector<double> numbers(const std::string& path) const;
  /// A text that is stored as a dataset.
  [[nodiscard]] std::string text(const std::string& path) const;
  /// The part of an array with the first index `index`.
  [[nodiscard]] std::vector<float> floats_at(const std::string& path, std::uint64_t index) const;
  [[nodiscard]] std::vector<std::uint8_t> bytes_at(const std::string& path,
                                                   std::uint64_t index) const;
  [[nodiscard]] std::string location(const std::string& path) const { return name_ + ":" + path; }
  [[noreturn]] void fail(const std::string& path, const std::string& problem) const;

 private:
  [[noreturn]] void fail_to_read(const std::string& path, hid_t dataset) const;
  [[nodiscard]] H5Handle dataset(const std::string& path) const;
  template <class T>
  [[nodiscard]] std::vector<T> slice(const std::string& path, std::uint64_t index,
                                     hid_t type) const;

  std::string name_;
  H5Handle file_;
};

/// Whether a file begins as HDF5 does.
[[nodiscard]] bool is_hdf5(const std::filesystem::path& file);

/// InputError(location) where a dataset claims more bytes than the space that it takes in the file can
/// unpack to, before anybody takes memory for them. Hold an H5Lock.
void check_h5_size(hid_t dataset, const std::string& location);

/// The text of a dataset or of an attribute; nullopt where it is no single text. Hold an H5Lock.
[[nodiscard]] std::optional<std::string> read_h5_text(hid_t dataset);
[[nodiscard]] std::optional<std::string> read_h5_text_attribute(hid_t attribute);

/// For an error of reading a dataset: which package or program brings its filter, "" where that is
/// known to be there or not known at all. Hold an H5Lock.
[[nodiscard]] std::string h5_filter_hint(hid_t dataset);

/// Whether there is something at an absolute path. Hold an H5Lock.
[[nodiscard]] bool has_h5_link(hid_t file, const std::string& path);

}  // namespace saccade
