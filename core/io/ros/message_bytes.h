#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>

#include "core/event.h"
#include "core/io/ros/message_file.h"

namespace saccade {

/// A message that is serialised field by field, as MessageReader reads it.
class MessageBytes {
 public:
  /// kRos1 or kCdr (contract).
  explicit MessageBytes(Serialisation serialisation);

  template <class T>
  void number(T value) {
    align(sizeof(T));
    bytes_.append(reinterpret_cast<const char*>(&value), sizeof value);
  }
  void numbers(std::span<const double> values) {
    for (const double value : values) number(value);
  }
  void flag(bool value) { number(static_cast<std::uint8_t>(value)); }
  /// Not before 1970 (contract).
  void time(TimeNs t_ns);
  void text(std::string_view value);
  /// A std_msgs/Header.
  void header(TimeNs t_ns, std::string_view frame);
  /// An array of bytes with its length.
  void byte_array(std::span<const std::byte> bytes);
  [[nodiscard]] std::span<const std::byte> bytes() const {
    return std::as_bytes(std::span(bytes_));
  }
  [[nodiscard]] bool is_cdr() const { return is_cdr_; }

 private:
  void align(std::size_t size);

  bool is_cdr_;
  std::uint32_t headers_ = 0;
  std::string bytes_;
};

}  // namespace saccade
