#pragma once

#include <string>

#include "core/image.h"
#include "simulator/scene/mesh/file_source.h"

namespace saccade {

/// A picture as the renderer uses it.
struct Picture {
  ImageF grey;     ///< linear light, 0.2126 R + 0.7152 G + 0.0722 B
  ImageF opacity;  ///< alpha in [0, 1]; empty where everything is opaque
};

/// Decodes 8-bit pictures (sRGB), OpenEXR and Radiance HDR (linear) by the file's ending.
/// InputError naming `source_name` when the bytes are no such picture or hold NaN, infinite or
/// negative light.
[[nodiscard]] Picture decode_picture(const Bytes& bytes, const std::string& source_name);

/// The plane that says how opaque a picture used as an alpha map is: its alpha channel, else its
/// grey codes as they are stored.
[[nodiscard]] ImageF decode_opacity(const Bytes& bytes, const std::string& source_name);

}  // namespace saccade
