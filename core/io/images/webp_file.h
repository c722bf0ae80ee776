#pragma once

#include <string>

#include "core/image.h"

namespace saccade {

constexpr int kMostWebpSide = 16383;  ///< of the format [px]

/// A lossless WebP picture: of drawings and events a quarter of the size of a PNG. Not empty, and
/// no side above kMostWebpSide (contract).
[[nodiscard]] std::string encode_webp(const ImageRgb8& image);

}  // namespace saccade
