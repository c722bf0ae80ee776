#pragma once

#include <cstdint>
#include <map>
#include <vector>

#include "simulator/scene/mesh/gltf_file.h"
#include "simulator/scene/mesh/model.h"

namespace saccade {

/// What of a glTF file moves: the nodes of its scene, its animations and its cameras, from its JSON
/// (assimp takes every interpolation for linear). Cameras look along -z of their node, +y upwards.
struct GltfMotion {
  std::vector<ModelNode> tree;
  std::map<std::size_t, std::uint32_t> tree_index;  ///< of the file's node k
  std::vector<ModelAnimation> animations;
  std::vector<ModelCamera> cameras;
};

/// Throws InputError naming the file where it is not as the specification has it.
[[nodiscard]] GltfMotion read_gltf_motion(const GltfFile& file);

/// Gives a model that assimp read from GltfFile::for_assimp(Stillness::kMoving) the nodes,
/// animations and cameras of the file, under their own names.
void take_gltf_motion(const GltfFile& file, Model& model);

}  // namespace saccade
