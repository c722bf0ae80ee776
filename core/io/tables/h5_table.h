#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <type_traits>
#include <vector>

namespace saccade {

enum class H5Type { kFloat32, kInt32, kUint16, kUint8 };

template <class T>
constexpr H5Type h5_type() {
  if constexpr (std::is_same_v<T, float>) return H5Type::kFloat32;
  if constexpr (std::is_same_v<T, std::int32_t>) return H5Type::kInt32;
  if constexpr (std::is_same_v<T, std::uint16_t>) return H5Type::kUint16;
  if constexpr (std::is_same_v<T, std::uint8_t>) return H5Type::kUint8;
}

/// A named column of values in memory.
template <class Byte>
struct H5Values {
  const char* name;
  H5Type type;
  std::span<Byte> bytes;
};
using H5Source = H5Values<const std::byte>;
using H5Target = H5Values<std::byte>;

template <class T>
[[nodiscard]] H5Source h5_source(const char* name, const std::vector<T>& values) {
  return {name, h5_type<T>(), std::as_bytes(std::span(values))};
}
template <class T>
[[nodiscard]] H5Target h5_target(const char* name, std::vector<T>& values) {
  return {name, h5_type<T>(), std::as_writable_bytes(std::span(values))};
}

/// Writes columns of equal length into one group of a file, chunked, shuffled and deflated as
/// events.h5 is. Nothing stands under the final name before close().
class H5TableWriter {
 public:
  /// `columns` tell names and types; their values are not written.
  H5TableWriter(const std::filesystem::path& file, const char* group,
                std::span<const H5Source> columns);
  ~H5TableWriter();

  /// Rows that follow those before; the same columns in the same order.
  void append(std::span<const H5Source> columns);
  void close();

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// Fills the columns from row `begin` on with as many rows as they have room for, of the `count`
/// that the group's columns must hold. InputError with the location for columns that are missing or
/// of another length, and for chunks that cannot be read.
void read_h5_table(const std::filesystem::path& file, const std::string& group, std::uint64_t count,
                   std::uint64_t begin, std::span<const H5Target> columns);

/// Whether the group of a file has a column; false as well where it is no HDF5 file. InputError where it
/// is one that cannot be opened.
[[nodiscard]] bool has_h5_column(const std::filesystem::path& file, const std::string& group,
                                 const std::string& name);

}  // namespace saccade
