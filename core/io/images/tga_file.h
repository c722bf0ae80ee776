#pragma once

#include <cstddef>
#include <span>
#include <string>

#include "core/io/images/image_file.h"

namespace saccade {

/// A Truevision TGA picture as its stored codes: colour, grey or with a palette, 8, 15, 16, 24 or
/// 32 bits per pixel, run-length encoded or not. Alpha is 255 where the file has none. The format
/// has no signature: only the file's name tells it. InputError naming `location` when the bytes are
/// of another kind or end too early.
[[nodiscard]] ImageRgba8 decode_tga(std::span<const std::byte> bytes, const std::string& location);

}  // namespace saccade
