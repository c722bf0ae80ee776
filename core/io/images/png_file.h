#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

#include "core/io/images/image_file.h"

namespace saccade {

[[nodiscard]] bool is_png(std::span<const std::byte> bytes);

/// The stored codes of a PNG picture of any kind: palette, grey, colour, 1 to 16 bits, interlaced.
/// Colour becomes grey by 0.299 R + 0.587 G + 0.114 B; alpha is dropped. Codes of 16 bits lose
/// their low byte. InputError naming `location` where the picture is damaged or ends too early.
[[nodiscard]] ImageU8 decode_png_grey(std::span<const std::byte> bytes,
                                      const std::string& location);
[[nodiscard]] ImageRgb8 decode_png_rgb(std::span<const std::byte> bytes,
                                       const std::string& location);
/// With alpha, also where it is stored as one transparent colour. Codes of 16 bits are rounded to
/// the nearest multiple of 256.
[[nodiscard]] ImageRgba8 decode_png_rgba(std::span<const std::byte> bytes,
                                         const std::string& location);
/// All bits of one or of three channels of 16 bits. InputError where the picture is of another kind.
[[nodiscard]] ImageU16 decode_png_u16(std::span<const std::byte> bytes,
                                      const std::string& location);
[[nodiscard]] ImageRgb16 decode_png_rgb16(std::span<const std::byte> bytes,
                                          const std::string& location);

}  // namespace saccade
