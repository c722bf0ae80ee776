#pragma once

#include <cstddef>
#include <span>
#include <string>

#include "core/io/images/exr_file.h"

namespace saccade {

/// A Radiance picture (.hdr): linear RGB as stored, an EXPOSURE of its header not undone (Ward,
/// "Real Pixels", Graphics Gems II, 1991). Rows from the top down, plain or run-length encoded per
/// component. InputError naming `location` when it is of another kind or ends too early.
[[nodiscard]] ImageRgbF decode_hdr(std::span<const std::byte> bytes, const std::string& location);

}  // namespace saccade
