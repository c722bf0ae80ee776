#pragma once

#include <functional>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace saccade {

/// How the document of a glTF file gets at what it refers to.
struct GltfAccess {
  /// All numbers of an accessor, which throws where its items are not of `width` numbers.
  std::function<std::vector<float>(std::size_t index, std::size_t width)> accessor;
  std::function<void(const std::string&)> fail;  ///< throws
};

/// Gives every node with EXT_mesh_gpu_instancing a child for each place of its mesh (TRANSLATION,
/// ROTATION and SCALE as lists), called as the node, which loses the mesh: assimp and all other
/// readers then see plain nodes. Fails where the lists differ in length, are of other types or hold
/// numbers that are not finite, or more than 100,000 places are stated in all.
void expand_gltf_instances(const GltfAccess& access, nlohmann::json& document);

}  // namespace saccade
