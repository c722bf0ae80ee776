#pragma once

#include <assimp/scene.h>

#include <string>

#include "simulator/scene/mesh/file_source.h"
#include "simulator/scene/mesh/mesh.h"
#include "simulator/scene/texture/texture_library.h"

namespace saccade {

/// Where a file's materials and textures come from.
struct MaterialContext {
  const aiScene& scene;
  const FileSource& source;
  std::filesystem::path mesh_file;  ///< in the source
  std::string source_name;          ///< of the mesh file, for errors
  TextureLibrary& textures;
};

struct ImportedMaterial {
  Material material;
  bool invisible = false;   ///< cut out everywhere
  unsigned uv_channel = 0;  ///< texture coordinates that the texture asks for
};

/// One assimp material in linear grey. Throws InputError naming the texture that is missing or
/// cannot be decoded.
[[nodiscard]] ImportedMaterial import_material(const aiMaterial& material,
                                               const MaterialContext& context);

}  // namespace saccade
