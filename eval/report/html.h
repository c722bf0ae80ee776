#pragma once

#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "core/image.h"

namespace saccade {

/// Text for HTML content and quoted attributes.
[[nodiscard]] std::string escape_html(std::string_view text);

/// The text of a JSON value for a <script> element, which would end at the first "</" or take what
/// follows "<!--" for a comment.
[[nodiscard]] std::string inside_script(std::string json);

/// RFC 4648, with padding.
[[nodiscard]] std::string base64(std::string_view bytes);

/// An image with caption; the picture is a lossless WebP inside the page. `caption` is HTML, `alt`
/// plain text.
[[nodiscard]] std::string figure(const ImageRgb8& picture, std::string_view caption,
                                 std::string_view alt);

/// HTML that the page's script inflates and puts in the place of this element when it comes near the
/// window (web/src/packed.js): a page of a thousand runs opens at once.
[[nodiscard]] std::string packed_html(std::string_view html);

/// Command lines that make a part of the page again, folded; empty without any that is known.
[[nodiscard]] std::string repeat_html(const std::vector<std::string>& commands);

/// Side of the square that an upscaled figure draws for a pixel: sensors are small [px].
inline constexpr int kUpscale = 2;

/// As figure(), upscaled.
[[nodiscard]] std::string upscaled_figure(const ImageRgb8& picture, std::string_view caption,
                                          std::string_view alt);

/// Replaces every {{name}} of the page once; values are not searched again. All names must be given
/// (contract).
[[nodiscard]] std::string fill_page(std::string_view page,
                                    const std::map<std::string, std::string>& values);

}  // namespace saccade
