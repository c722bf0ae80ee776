#include "apps/option_checks.h"

#include <fmt/core.h>

#include <charconv>
#include <cmath>
#include <functional>
#include <optional>
#include <string>

namespace saccade {
namespace {

template <class Number>
std::optional<Number> parsed(const std::string& text) {
  Number number{};
  const char* const end = text.data() + text.size();
  const auto [rest, error] = std::from_chars(text.data(), end, number);
  if (error != std::errc() || rest != end) return std::nullopt;
  return number;
}

/// An empty text from a check means that the value is right.
CLI::Validator validator(std::function<bool(const std::string&)> is_right, std::string expected) {
  const auto check = [=](const std::string& text) {
    return is_right(text) ? std::string() : fmt::format("expected {}, got '{}'", expected, text);
  };
  return CLI::Validator(check, "");
}

CLI::Validator number(double least, double most, bool least_itself, const std::string& expected) {
  const auto is_right = [=](const std::string& text) {
    const std::optional<double> value = parsed<double>(text);
    return value && std::isfinite(*value) && *value <= most &&
           (least_itself ? *value >= least : *value > least);
  };
  return validator(is_right, expected);
}

constexpr double kInfinity = std::numeric_limits<double>::infinity();

}  // namespace

CLI::Validator whole_number(std::uint64_t least, std::uint64_t most) {
  const auto is_right = [=](const std::string& text) {
    const std::optional<std::uint64_t> value = parsed<std::uint64_t>(text);
    return value && *value >= least && *value <= most;
  };
  return validator(is_right, fmt::format("a whole number from {} to {}", least, most));
}

CLI::Validator finite_number() { return number(-kInfinity, kInfinity, true, "a finite number"); }

CLI::Validator positive_number() { return number(0, kInfinity, false, "a finite number above 0"); }

CLI::Validator number_between(double least, double most) {
  return number(least, most, true, fmt::format("a number from {} to {}", least, most));
}

}  // namespace saccade
