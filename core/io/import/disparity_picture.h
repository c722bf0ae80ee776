#pragma once

#include <cstdint>
#include <filesystem>

#include "core/image.h"

namespace saccade {

/// The codes of a 16-bit grey picture (PNG), such as disparities are published in. InputError with
/// the path where it is none.
[[nodiscard]] Image<std::uint16_t> read_16bit_picture(const std::filesystem::path& file);

}  // namespace saccade
