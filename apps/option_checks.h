#pragma once

#include <CLI/CLI.hpp>
#include <cstdint>
#include <limits>

namespace saccade {

/// The longest time whose nanoseconds a clock can count [s].
constexpr double kLongest_s = 4e9;

/// Checks of the text of an option's value. CLI11's own let NaN and wrapped negative numbers pass
/// and name bounds of 308 digits.

/// Digits alone, `least` <= value <= `most`.
[[nodiscard]] CLI::Validator whole_number(
    std::uint64_t least, std::uint64_t most = std::numeric_limits<std::int32_t>::max());

/// Any finite number.
[[nodiscard]] CLI::Validator finite_number();
/// Finite, > 0.
[[nodiscard]] CLI::Validator positive_number();
/// `least` <= value <= `most`.
[[nodiscard]] CLI::Validator number_between(double least, double most);

}  // namespace saccade
