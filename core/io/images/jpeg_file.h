#pragma once

#include <cstddef>
#include <span>
#include <string>

#include "core/image.h"

namespace saccade {

[[nodiscard]] bool is_jpeg(std::span<const std::byte> bytes);

/// The codes of a JPEG picture, baseline or progressive, grey, YCbCr, RGB or CMYK, as they are
/// stored: an orientation noted by a camera turns nothing. Grey is the stored luminance. InputError
/// naming `location` where the picture is damaged or ends too early.
[[nodiscard]] ImageU8 decode_jpeg_grey(std::span<const std::byte> bytes,
                                       const std::string& location);
[[nodiscard]] ImageRgb8 decode_jpeg_rgb(std::span<const std::byte> bytes,
                                        const std::string& location);

}  // namespace saccade
