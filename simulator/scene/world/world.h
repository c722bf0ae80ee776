#pragma once

#include <memory>
#include <vector>

#include "simulator/scene/colour_channel.h"
#include "simulator/scene/scene_remarks.h"
#include "simulator/scene/world/world_layout.h"
#include "simulator/scene/world/world_options.h"

namespace saccade {

/// What a world adds to a scene: generated objects, whose meshes have their materials, and meshes
/// of files.
struct World {
  std::vector<WorldPart> parts;
  std::vector<MeshOptions> files;
};

/// A pure function of `options` and of the pictures it reads. Throws InputError naming the Debian
/// package of a picture that is missing. `channel`: what its textures show of pictures.
[[nodiscard]] World make_world(const WorldOptions& options, SceneRemarks& remarks,
                               ColourChannel channel = ColourChannel::kLuminance);

}  // namespace saccade
