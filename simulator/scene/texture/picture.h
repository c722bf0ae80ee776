#pragma once

#include <string>

#include "core/image.h"
#include "core/io/images/exr_file.h"
#include "simulator/scene/colour_channel.h"
#include "simulator/scene/mesh/file_source.h"
#include "simulator/scene/scene_remarks.h"

namespace saccade {

/// A picture as the renderer uses it.
struct Picture {
  ImageF grey;     ///< linear light in one channel, by default 0.2126 R + 0.7152 G + 0.0722 B
  ImageF opacity;  ///< alpha in [0, 1]; empty where alpha is 1 all over
};

/// Decodes 8-bit pictures (sRGB), OpenEXR and Radiance HDR (linear) by the file's ending. `factors`
/// multiply R, G and B in linear light. Light below 0 by at most a hundredth of the brightest texel,
/// as filters leave it at edges, counts as 0, with a remark. InputError naming `source_name` when
/// the bytes are no such picture, or hold light that is NaN, infinite or further below 0.
[[nodiscard]] Picture decode_picture(const Bytes& bytes, const std::string& source_name,
                                     SceneRemarks& remarks, const RgbF& factors = {1, 1, 1},
                                     ColourChannel channel = ColourChannel::kLuminance);

/// The plane that says how opaque a picture used as an alpha map is: its alpha channel, else its
/// grey codes as they are stored.
[[nodiscard]] ImageF decode_opacity(const Bytes& bytes, const std::string& source_name,
                                    SceneRemarks& remarks);

}  // namespace saccade
