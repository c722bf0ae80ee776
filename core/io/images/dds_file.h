#pragma once

#include <cstddef>
#include <span>
#include <string>

#include "core/io/images/image_file.h"

namespace saccade {

/// Whether the bytes begin as a DirectDraw surface does.
[[nodiscard]] bool is_dds(std::span<const std::byte> bytes);

/// The largest picture of a DirectDraw surface as its stored codes: block compression BC1 to BC3
/// (DXT1, DXT3, DXT5) and uncompressed grey, RGB and RGBA of 8, 16, 24 or 32 bits. InputError
/// naming `location` when it is of another format, which the message names, or ends too early.
[[nodiscard]] ImageRgba8 decode_dds(std::span<const std::byte> bytes, const std::string& location);

}  // namespace saccade
