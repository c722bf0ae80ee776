#pragma once

#include "simulator/scene/colour_channel.h"
#include "simulator/scene/scene.h"
#include "simulator/scene/scene_options.h"

namespace saccade {

/// Reads all files of `options` and assembles them. Warns of what they state that is not shown, in
/// few lines. Throws InputError naming the file that is missing or wrong.
/// `channel`: what the scene's light is of its colours; only the luminance warns.
[[nodiscard]] Scene build_scene(const SceneOptions& options,
                                ColourChannel channel = ColourChannel::kLuminance);

}  // namespace saccade
