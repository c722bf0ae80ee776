#pragma once

#include <filesystem>

#include "simulator/scene/mesh/file_source.h"
#include "simulator/scene/mesh/model.h"

namespace saccade {

/// Whether a file of this name is a map: *.bsp.
[[nodiscard]] bool is_quake3_map(const std::filesystem::path& file);

/// Whether it is one of the game's archives: *.pk3.
[[nodiscard]] bool is_quake3_archive(const std::filesystem::path& file);

/// The surfaces of a map of Quake III Arena (IBSP of version 46 or 47), z upwards and in metres: 32
/// of its units are one, by which a player is 1.75 m tall. Polygons and meshes are shown as they
/// are, curved surfaces divided (divide_patch()); skies, flares and what the map says is not drawn
/// are left out. The world is one node, and so is each entity with surfaces of its own, as a door,
/// where the map begins with it. Materials are called as the game's shaders, whose pictures
/// Quake3Materials finds. The places where players begin are cameras. Throws std::runtime_error
/// where the map is damaged, of another version, or claims more vertices than any that the game
/// loads.
[[nodiscard]] Model read_quake3_map(const Bytes& bytes);

}  // namespace saccade
