#pragma once

#include <cstddef>
#include <span>
#include <string>

#include "core/io/images/image_file.h"

namespace saccade {

constexpr int kMostWebpSide = 16383;  ///< of the format [px]

/// A lossless WebP picture: of drawings and events a quarter of the size of a PNG. Not empty, and
/// no side above kMostWebpSide (contract).
[[nodiscard]] std::string encode_webp(const ImageRgb8& image);

[[nodiscard]] bool is_webp(std::span<const std::byte> bytes);

/// A still WebP picture, lossless or not. InputError naming `location` where it is damaged, ends
/// too early or is a film.
[[nodiscard]] ImageRgba8 decode_webp(std::span<const std::byte> bytes, const std::string& location);

}  // namespace saccade
