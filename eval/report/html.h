#pragma once

#include <map>
#include <optional>
#include <string>
#include <string_view>

#include "core/image.h"

namespace saccade {

/// Text for HTML content and quoted attributes.
[[nodiscard]] std::string escape_html(std::string_view text);

/// RFC 4648, with padding.
[[nodiscard]] std::string base64(std::string_view bytes);

/// An image with caption; the picture is a PNG inside the page. `caption` is HTML, `alt` plain
/// text.
[[nodiscard]] std::string figure(const ImageRgb8& picture, std::string_view caption,
                                 std::string_view alt);

/// Replaces every {{name}} of the page once; values are not searched again. All names must be given
/// (contract).
[[nodiscard]] std::string fill_page(std::string_view page,
                                    const std::map<std::string, std::string>& values);

/// `value` with `digits` significant digits but no exponent ("0.0123", "12300"); a dash for
/// nothing.
[[nodiscard]] std::string significant(const std::optional<double>& value, int digits = 3);

/// With `decimals` decimals; a dash for nothing.
[[nodiscard]] std::string fixed(const std::optional<double>& value, int decimals);

/// 1,234,567; a dash for nothing.
[[nodiscard]] std::string grouped(const std::optional<double>& value);

}  // namespace saccade
