#pragma once

#include <vector>

#include "simulator/scene/colour_channel.h"
#include "simulator/scene/light/light_options.h"
#include "simulator/scene/mesh/gltf_file.h"

namespace saccade {

/// The lights of a glTF file (Khronos, KHR_lights_punctual, 2018) where the nodes of its scene put
/// them, in the file's coordinates. Their intensity is that of the file, in candela or, of
/// directional lights, in lux, times their colour in `channel`; `range` is not used. Throws
/// InputError naming the file and the light that is not as the extension has it.
[[nodiscard]] std::vector<LightOptions> read_gltf_lights(const GltfFile& file,
                                                         ColourChannel channel);

}  // namespace saccade
