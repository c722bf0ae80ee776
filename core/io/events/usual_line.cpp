#include "core/io/events/usual_line.h"

#include <array>
#include <cstdint>

#include "core/io/tables/leading_digits.h"

namespace saccade {
namespace {

/// More than such a line has, with the eight bytes that are looked at from its last field on.
constexpr std::size_t kReadableBytes = 64;

/// What decimals are worth by their number [ns].
constexpr std::array<std::uint32_t, 9> kNanoseconds{
    0, 100'000'000, 10'000'000, 1'000'000, 100'000, 10'000, 1'000, 100, 10};

/// Seconds of 1 to 8 digits, and decimals; false for other numbers. `at` moves behind the space.
bool read_time(const char*& at, TimeNs& t_ns) {
  const LeadingDigits seconds = leading_digits(at);
  at += seconds.count;
  if (seconds.count == 0 || *at++ != '.') return false;
  const LeadingDigits decimals = leading_digits(at);
  at += decimals.count;
  std::uint32_t nanoseconds = decimals.value * kNanoseconds[decimals.count];
  const auto ninth = static_cast<std::uint32_t>(*at - '0');
  if (decimals.count == 8 && ninth < 10) {
    nanoseconds += ninth;
    ++at;
  }
  t_ns = TimeNs{seconds.value} * 1'000'000'000 + nanoseconds;
  return decimals.count > 0 && *at++ == ' ';
}

/// A number below 65536 and the space behind it.
bool read_coordinate_before_space(const char*& at, std::uint16_t& coordinate) {
  const LeadingDigits digits = leading_digits(at);
  at += digits.count;
  coordinate = static_cast<std::uint16_t>(digits.value);
  return digits.count > 0 && digits.value < 65536 && *at++ == ' ';
}

}  // namespace

std::size_t read_usual_line(std::string_view text, Event& event) {
  if (text.size() < kReadableBytes) return 0;
  const char* at = text.data();
  if (!read_time(at, event.t_ns) || !read_coordinate_before_space(at, event.x) ||
      !read_coordinate_before_space(at, event.y))
    return 0;
  const auto polarity = static_cast<std::uint32_t>(at[0] - '0');
  if (polarity > 1 || at[1] != '\n') return 0;
  event.polarity = static_cast<std::int8_t>(2 * static_cast<int>(polarity) - 1);
  return static_cast<std::size_t>(at + 2 - text.data());
}

}  // namespace saccade
