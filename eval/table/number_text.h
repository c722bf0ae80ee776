#pragma once

#include <optional>
#include <string>

namespace saccade {

/// `value` with `digits` significant digits but no exponent ("0.0123", "12300"); a dash for
/// nothing.
[[nodiscard]] std::string significant(const std::optional<double>& value, int digits = 3);

/// With `decimals` decimals; a dash for nothing.
[[nodiscard]] std::string fixed(const std::optional<double>& value, int decimals);

/// Three significant digits without an exponent, thousands in groups ("0.0123", "12,300"); a dash
/// for nothing.
[[nodiscard]] std::string rounded(const std::optional<double>& value);

/// 1,234,567; a dash for nothing.
[[nodiscard]] std::string grouped(const std::optional<double>& value);

}  // namespace saccade
