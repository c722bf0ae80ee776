#pragma once

#include <cstddef>
#include <span>
#include <string>

#include "core/io/images/image_file.h"

namespace saccade {

[[nodiscard]] bool is_tiff(std::span<const std::byte> bytes);

/// The first picture of a TIFF file of whole numbers, at 8 bits; of more the upper ones. Colours
/// are multiplied by an alpha that the file states to be apart. InputError naming `location` where
/// it is of another kind, damaged or ends too early.
[[nodiscard]] ImageRgba8 decode_tiff(std::span<const std::byte> bytes, const std::string& location);

}  // namespace saccade
