#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "simulator/scene/mesh/file_source.h"
#include "simulator/scene/mesh/gltf_file.h"
#include "simulator/scene/mesh/material_import.h"
#include "simulator/scene/mesh/mesh.h"
#include "simulator/scene/mesh/model.h"
#include "simulator/scene/mesh/model_imports.h"
#include "simulator/scene/scene_remarks.h"
#include "simulator/scene/texture/texture_library.h"

namespace saccade {

/// What a scene states about the surface of a mesh, other than its file.
struct MeshSurface {
  std::optional<std::filesystem::path> texture;  ///< in place of all colours
  std::optional<std::uint64_t> texture_seed;     ///< of a generated one
  double reflectance = 1;                        ///< multiplies every albedo
  std::optional<Gloss> gloss;                    ///< in place of those of its materials

  /// False: as the file states it.
  [[nodiscard]] bool is_changed() const { return texture || reflectance != 1 || gloss; }
};

/// Reads meshes through assimp, from disk or from within zip archives, with their materials and
/// textures. Vertices keep the axes and units of their file; nodes are flattened, polygons
/// triangulated, points, lines and wholly transparent surfaces left out. Files without normals are
/// shaded smoothly where faces meet at less than 40 degrees. A texture replaces the material's
/// colour (whose value beside one means nothing in most files), except in glTF, which defines their
/// product (gltf_material.h), and in maps of Quake III, whose pictures and scripts are in the
/// archives of their game (quake3/). A *.relief.yaml on disk is a surface of generate_relief().
/// Archives stay open and textures loaded as long as the importer lives. Not thread-safe.
class MeshImporter {
 public:
  explicit MeshImporter(const MeshImportOptions& options = {});
  MeshImporter(const MeshImporter&) = delete;
  MeshImporter& operator=(const MeshImporter&) = delete;

  /// Begins to import meshes, several at a time, that read() will be asked for in this order. What
  /// is wrong with one of them is for read() to say.
  void prefetch(const std::vector<std::filesystem::path>& files);

  /// Throws InputError naming the file, its material library or its texture: missing or unreadable,
  /// of a format that assimp does not know, without triangles, with a vertex that is not finite, or
  /// with a texture but no texture coordinates; and where assimp's importer crashes, hangs or takes
  /// too much memory (import_model()).
  /// `animation`: name of the one that the mesh gets, as find_animation() has it; nullopt: it is
  /// still. With one, the same holds for files whose animation cannot be played.
  [[nodiscard]] Mesh read(const std::filesystem::path& file,
                          const std::optional<std::string>& animation = std::nullopt);

  /// The mesh with another surface. Throws InputError naming the texture where it is missing or
  /// wrong, and `user` where the mesh has no texture coordinates for it.
  [[nodiscard]] Mesh with_surface(Mesh mesh, const MeshSurface& surface, const std::string& user);

  /// What the meshes show otherwise than their files say.
  [[nodiscard]] SceneRemarks& remarks() { return remarks_; }

 private:
  /// `gltf`: none for other formats. `is_moving`: with what moves it.
  [[nodiscard]] Model read_model(const std::filesystem::path& file, const FileSource& source,
                                 const std::optional<GltfFile>& gltf, bool is_moving);
  [[nodiscard]] Mesh read_relief(const FileLocation& location, const FileSource& source);

  MeshImportOptions options_;
  SceneRemarks remarks_;
  std::map<std::filesystem::path, FileSource> sources_;
  std::optional<ModelImports> imports_;
  TextureLibrary textures_;
};

}  // namespace saccade
