#pragma once

#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include "core/error.h"

namespace saccade {

/// Appends values to a state that the same build reads back.
class StateWriter {
 public:
  template <class T>
  void value(const T& value) {
    static_assert(std::is_trivially_copyable_v<T>);
    bytes_.append(reinterpret_cast<const char*>(&value), sizeof value);
  }
  template <class T>
  void values(const std::vector<T>& values) {
    static_assert(std::is_trivially_copyable_v<T>);
    value(std::uint64_t{values.size()});
    if (!values.empty())
      bytes_.append(reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T));
  }
  void text(std::string_view text) {
    value(std::uint64_t{text.size()});
    bytes_.append(text);
  }
  [[nodiscard]] const std::string& bytes() const { return bytes_; }

 private:
  std::string bytes_;
};

/// Reads what a StateWriter wrote, in the same order. A state that is too short throws InputError.
class StateReader {
 public:
  explicit StateReader(std::string_view bytes) : bytes_(bytes) {}

  template <class T>
  void value(T& value) {
    static_assert(std::is_trivially_copyable_v<T>);
    const std::string_view from = next(1, sizeof value);
    std::memcpy(&value, from.data(), sizeof value);
  }
  template <class T>
  void values(std::vector<T>& values) {
    static_assert(std::is_trivially_copyable_v<T>);
    std::uint64_t size = 0;
    value(size);
    const std::string_view from = next(size, sizeof(T));
    values.resize(size);
    if (size > 0) std::memcpy(values.data(), from.data(), from.size());
  }
  [[nodiscard]] std::string_view text() {
    std::uint64_t size = 0;
    value(size);
    return next(size, 1);
  }
  [[nodiscard]] bool at_end() const { return bytes_.empty(); }

 private:
  std::string_view next(std::uint64_t count, std::size_t size) {
    if (count > bytes_.size() / size)
      throw InputError("saved state", "is too short; start the simulation afresh");
    const std::string_view piece = bytes_.substr(0, count * size);
    bytes_.remove_prefix(piece.size());
    return piece;
  }

  std::string_view bytes_;
};

}  // namespace saccade
