#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/io/files/zip_archive.h"
#include "core/io/tables/npy_header.h"

namespace saccade {

/// An array of NumPy's, read row by row from front to back.
class NumpyArray {
 public:
  /// Fills bytes and returns how many there were, fewer only at the end.
  using Source = std::function<std::size_t(std::span<std::byte>)>;

  NumpyArray(std::string location, Source source);

  [[nodiscard]] const NpyHeader& header() const { return header_; }
  [[nodiscard]] const std::string& location() const { return location_; }
  /// As many as the first dimension says; a single number is one row.
  [[nodiscard]] std::uint64_t rows() const { return header_.shape.empty() ? 1 : header_.shape[0]; }
  [[nodiscard]] std::size_t row_bytes() const { return row_bytes_; }
  void set_row_bytes(std::size_t bytes) { row_bytes_ = bytes; }

  /// The next rows, `most` at most, fewer where they are long, none at the end; valid until the next
  /// call. InputError where the file ends early or holds no numbers.
  [[nodiscard]] std::span<const std::byte> read(std::size_t most);
  /// Of an array of a single text in ASCII.
  [[nodiscard]] std::string text();

 private:
  /// Of any type.
  [[nodiscard]] std::span<const std::byte> read_rows(std::size_t most);
  std::string location_;
  Source source_;
  NpyHeader header_;
  std::size_t row_bytes_ = 0;
  std::uint64_t done_ = 0;
  std::vector<std::byte> block_;
};

/// A file of one array or an archive of several.
class NumpyFile {
 public:
  explicit NumpyFile(const std::filesystem::path& file);

  [[nodiscard]] bool is_archive() const { return archive_ != nullptr; }
  /// Of the arrays in an archive, without ".npy".
  [[nodiscard]] const std::vector<std::string>& names() const { return names_; }
  [[nodiscard]] bool contains(const std::string& name) const;
  /// `name`: in an archive.
  [[nodiscard]] NumpyArray open(const std::string& name) const;
  [[nodiscard]] std::string location() const { return path_.string(); }
  [[nodiscard]] std::uint64_t size() const { return std::filesystem::file_size(path_); }

 private:
  std::filesystem::path path_;
  std::unique_ptr<ZipArchive> archive_;
  std::vector<std::string> names_;
};

/// One field of all rows; numbers with a fraction are cut.
void read_whole_numbers(std::span<const std::byte> rows, std::size_t row_bytes,
                        const NpyField& field, std::vector<std::int64_t>& values);
/// Floating seconds -> ns; what is no time becomes the least of all.
void read_seconds(std::span<const std::byte> rows, std::size_t row_bytes, const NpyField& field,
                  std::vector<std::int64_t>& values_ns);

}  // namespace saccade
