#include "core/io/ros/message_bytes.h"

#include "core/check.h"

namespace saccade {
namespace {

/// Plain CDR of little-endian numbers, without options.
constexpr std::string_view kCdrEncapsulation{"\x00\x01\x00\x00", 4};

}  // namespace

MessageBytes::MessageBytes(Serialisation serialisation)
    : is_cdr_(serialisation == Serialisation::kCdr) {
  SACCADE_CHECK(serialisation != Serialisation::kOther);
  if (is_cdr_) bytes_ = kCdrEncapsulation;
}

void MessageBytes::align(std::size_t size) {
  if (!is_cdr_) return;
  const std::size_t used = bytes_.size() - kCdrEncapsulation.size();
  bytes_.append((size - used % size) % size, '\0');
}

void MessageBytes::time(TimeNs t_ns) {
  SACCADE_CHECK(t_ns >= 0);
  number(static_cast<std::uint32_t>(t_ns / 1'000'000'000));
  number(static_cast<std::uint32_t>(t_ns % 1'000'000'000));
}

void MessageBytes::text(std::string_view value) {
  number(static_cast<std::uint32_t>(value.size() + (is_cdr_ ? 1 : 0)));
  bytes_.append(value);
  if (is_cdr_) bytes_ += '\0';
}

void MessageBytes::header(TimeNs t_ns, std::string_view frame) {
  if (!is_cdr_) number(headers_++);
  time(t_ns);
  text(frame);
}

void MessageBytes::byte_array(std::span<const std::byte> bytes) {
  number(static_cast<std::uint32_t>(bytes.size()));
  bytes_.append(reinterpret_cast<const char*>(bytes.data()), bytes.size());
}

}  // namespace saccade
