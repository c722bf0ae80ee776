#pragma once

#include <cstddef>
#include <span>
#include <string>

#include "core/io/images/image_file.h"

namespace saccade {

[[nodiscard]] bool is_bmp(std::span<const std::byte> bytes);

/// A Windows bitmap as its stored codes: palettes of 1, 4 and 8 bits, run-length encoded or not,
/// and 16, 24 or 32 bits per pixel; codes of five and six bits become the upper ones of eight.
/// Alpha is 255 where the file states no mask for it. InputError naming `location` when it is of
/// another kind or ends too early.
[[nodiscard]] ImageRgba8 decode_bmp(std::span<const std::byte> bytes, const std::string& location);

}  // namespace saccade
