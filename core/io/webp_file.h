#pragma once

#include <string>

#include "core/image.h"

namespace saccade {

/// A lossless WebP picture: of drawings and events a quarter of the size of a PNG. Not empty
/// (contract).
[[nodiscard]] std::string encode_webp(const ImageRgb8& image);

}  // namespace saccade
