#pragma once

#include <array>
#include <optional>
#include <string>

#include <Eigen/Geometry>

#include "simulator/scene/colour_channel.h"
#include "simulator/scene/mesh/file_source.h"
#include "simulator/scene/mesh/mesh.h"
#include "simulator/scene/mesh/model.h"
#include "simulator/scene/texture/texture_library.h"

namespace saccade {

/// How the files of a scene are read.
struct MeshImportOptions {
  MissingTexture missing_texture = MissingTexture::kError;
  bool is_lit = false;  ///< by lights; otherwise the albedo is the radiance
  ColourChannel channel = ColourChannel::kLuminance;  ///< what becomes of colours
  bool takes_lights = false;                          ///< of glTF files
  bool takes_normal_maps = true;                      ///< where lights are
  bool takes_gloss = false;                           ///< of glTF files, where lights are
};

/// Where a file's materials and textures come from.
struct MaterialContext {
  const FileSource& source;
  std::filesystem::path mesh_file;  ///< in the source
  std::string source_name;          ///< of the mesh file, for errors
  MeshImportOptions options;
  TextureLibrary& textures;
  SceneRemarks& remarks;
  bool is_animated = false;  ///< its vertices move
};

struct ImportedMaterial {
  Material material;
  bool invisible = false;        ///< cut out everywhere
  std::uint32_t uv_channel = 0;  ///< texture coordinates that the texture asks for
  std::optional<Eigen::Affine2d> uv_transform;
  std::uint32_t normal_uv_channel = 0;  ///< those that the normal map asks for
  std::optional<Eigen::Affine2d> normal_uv_transform{};
  /// Linear colour that vertex colours, linear as well, multiply. None: they are sRGB and replace
  /// the albedo.
  std::optional<std::array<float, 3>> colour;
  double emission = 0;  ///< part of the albedo or of the texture
};

/// One material of a model in linear grey. Throws InputError naming the texture that is missing or
/// cannot be decoded, unless it may be grey.
[[nodiscard]] ImportedMaterial import_material(const Model& model, const ModelMaterial& material,
                                               const MaterialContext& context);

/// Remarks that a normal map is not shown; false where it is.
[[nodiscard]] bool leaves_out_normal_map(const MaterialContext& context);

/// Linear colour in one channel.
[[nodiscard]] double grey_of(const std::array<float, 3>& colour, ColourChannel channel);

}  // namespace saccade
