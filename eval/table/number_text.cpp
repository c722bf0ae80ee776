#include "eval/table/number_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace saccade {
namespace {

constexpr const char* kNothing = "–";

}  // namespace

std::string significant(const std::optional<double>& value, int digits) {
  if (!value) return kNothing;
  if (*value == 0) return "0";
  const int magnitude = static_cast<int>(std::floor(std::log10(std::abs(*value))));
  const int decimals = digits - 1 - magnitude;
  if (decimals >= 0) return fmt::format("{:.{}f}", *value, std::min(decimals, 12));
  const double unit = std::pow(10, -decimals);
  return fmt::format("{:.0f}", std::round(*value / unit) * unit);
}

std::string fixed(const std::optional<double>& value, int decimals) {
  return value ? fmt::format("{:.{}f}", *value, decimals) : kNothing;
}

std::string grouped(const std::optional<double>& value) {
  if (!value) return kNothing;
  std::string digits = fmt::format("{:.0f}", *value);
  const int first = digits.front() == '-' ? 1 : 0;
  for (auto at = static_cast<int>(digits.size()) - 3; at > first; at -= 3)
    digits.insert(static_cast<std::size_t>(at), 1, ',');
  return digits;
}

std::string rounded(const std::optional<double>& value) {
  if (!value || std::abs(*value) < 1000) return significant(value);
  const double unit = std::pow(10, std::floor(std::log10(std::abs(*value))) - 2);
  return grouped(std::round(*value / unit) * unit);
}

}  // namespace saccade
