#pragma once

#include <filesystem>
#include <string>

#include "simulator/scene/scene_options.h"

namespace saccade {

/// Whether a file of this name is one that meshes are read from (a member of an archive counts by
/// its own name).
[[nodiscard]] bool is_mesh_name(const std::filesystem::path& path);

/// What a mesh file holds, in lines for a terminal: size, triangles, materials, textures with their
/// sizes, lights, cameras, animations, what of it is missing or not shown, and an entry of
/// `scene.meshes` that stands it upright. Throws InputError where the file cannot be read at all.
[[nodiscard]] std::string describe_mesh(const std::filesystem::path& file);

/// The same in a line per mesh file of a scene, with what all of them are missing.
[[nodiscard]] std::string describe_scene(const SceneOptions& options);

}  // namespace saccade
