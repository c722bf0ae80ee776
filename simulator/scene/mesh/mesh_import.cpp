#include "simulator/scene/mesh/mesh_import.h"

#include <assimp/config.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>
#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <assimp/Importer.hpp>
#include <cmath>
#include <utility>

#include "core/error.h"
#include "core/srgb.h"
#include "simulator/scene/mesh/assimp_files.h"
#include "simulator/scene/mesh/material_import.h"
#include "simulator/scene/mesh/relief.h"

namespace saccade {
namespace {

namespace fs = std::filesystem;

constexpr float kSmoothingAngleDeg = 40;

Eigen::Vector3d vector_of(const aiVector3D& v) { return {v.x, v.y, v.z}; }

Eigen::Affine3d transform_of(const aiMatrix4x4& m) {
  Eigen::Affine3d transform;
  transform.matrix() << m.a1, m.a2, m.a3, m.a4, m.b1, m.b2, m.b3, m.b4, m.c1, m.c2, m.c3, m.c4,
      m.d1, m.d2, m.d3, m.d4;
  return transform;
}

const aiScene& load(Assimp::Importer& importer, AssimpFiles* files, const fs::path& file,
                    const std::string& source_name) {
  importer.SetIOHandler(files);
  importer.SetPropertyInteger(AI_CONFIG_PP_SBP_REMOVE,
                              aiPrimitiveType_POINT | aiPrimitiveType_LINE);
  importer.SetPropertyFloat(AI_CONFIG_PP_GSN_MAX_SMOOTHING_ANGLE, kSmoothingAngleDeg);
  importer.SetPropertyBool(AI_CONFIG_IMPORT_COLLADA_IGNORE_UP_DIRECTION, true);
  const std::string extension = file.extension().string();
  if (!importer.IsExtensionSupported(extension))
    throw InputError(source_name,
                     fmt::format("meshes of format '{}' cannot be read; OBJ, glTF, PLY, "
                                 "COLLADA, FBX, STL and others can",
                                 extension));
  const aiScene* scene =
      importer.ReadFile(file.generic_string(),
                        aiProcess_Triangulate | aiProcess_GenSmoothNormals | aiProcess_SortByPType);
  for (const std::string& missing : files->missing())
    if (missing.ends_with(".mtl") &&
        std::ranges::none_of(files->opened(), [](const auto& f) { return f.ends_with(".mtl"); }))
      throw InputError(source_name, fmt::format("its material library {} does not exist",
                                                fs::path(missing).lexically_normal().string()));
  if (scene == nullptr)
    throw InputError(source_name,
                     fmt::format("cannot be read as a mesh: {}", importer.GetErrorString()));
  return *scene;
}

/// Libraries hold materials, with textures, that no face uses; those stay empty.
std::vector<ImportedMaterial> used_materials(const MaterialContext& context) {
  std::vector<ImportedMaterial> materials(context.scene.mNumMaterials);
  std::vector<bool> done(materials.size());
  for (unsigned i = 0; i < context.scene.mNumMeshes; ++i) {
    const unsigned index = context.scene.mMeshes[i]->mMaterialIndex;
    if (!done[index]) materials[index] = import_material(*context.scene.mMaterials[index], context);
    done[index] = true;
  }
  return materials;
}

/// Copies assimp's meshes into one.
class Flattener {
 public:
  Flattener(const aiScene& scene, std::vector<ImportedMaterial> materials, std::string source_name)
      : scene_(scene), materials_(std::move(materials)), source_name_(std::move(source_name)) {
    for (const ImportedMaterial& imported : materials_)
      mesh_.materials.push_back(imported.material);
  }

  void add(const aiNode& node, const Eigen::Affine3d& file_from_parent) {
    const Eigen::Affine3d file_from_node = file_from_parent * transform_of(node.mTransformation);
    for (unsigned i = 0; i < node.mNumMeshes; ++i)
      add(*scene_.mMeshes[node.mMeshes[i]], file_from_node);
    for (unsigned i = 0; i < node.mNumChildren; ++i) add(*node.mChildren[i], file_from_node);
  }

  [[nodiscard]] Mesh take() {
    if (mesh_.triangles.empty()) throw InputError(source_name_, "holds no visible triangle");
    return std::move(mesh_);
  }

 private:
  void add(const aiMesh& part, const Eigen::Affine3d& file_from_node) {
    const ImportedMaterial& imported = materials_[part.mMaterialIndex];
    const Material& material = imported.material;
    const bool textured = material.texture != nullptr || material.opacity != nullptr;
    if (!imported.invisible && textured && !part.HasTextureCoords(imported.uv_channel))
      throw InputError(source_name_,
                       fmt::format("material '{}' has a texture, but its faces have no "
                                   "texture coordinates",
                                   material_name(part)));
    const std::size_t first = mesh_.vertices.size();
    const Eigen::Matrix3d normal_matrix = file_from_node.linear().inverse().transpose();
    for (unsigned i = 0; i < part.mNumVertices; ++i) {
      mesh_.vertices.push_back(file_from_node * vector_of(part.mVertices[i]));
      check_finite(mesh_.vertices.back(), first + i);
      mesh_.normals.push_back(normal_of(part, i, normal_matrix));
      mesh_.uvs.push_back(uv_of(part, i, imported.uv_channel));
      mesh_.colours.push_back(colour_of(part, i, material));
    }
    // Vertices stay in any case: a model's size is that of all its parts.
    if (!imported.invisible) add_faces(part, static_cast<std::uint32_t>(first));
  }

  void add_faces(const aiMesh& part, std::uint32_t first) {
    for (unsigned i = 0; i < part.mNumFaces; ++i) {
      const aiFace& face = part.mFaces[i];
      if (face.mNumIndices != 3) continue;
      mesh_.triangles.push_back(
          {{first + face.mIndices[0], first + face.mIndices[1], first + face.mIndices[2]},
           part.mMaterialIndex});
    }
  }

  void check_finite(const Eigen::Vector3d& vertex, std::size_t index) const {
    if (!vertex.allFinite())
      throw InputError(source_name_, fmt::format("vertex {} is not finite", index));
  }

  static Eigen::Vector3d normal_of(const aiMesh& part, unsigned i, const Eigen::Matrix3d& matrix) {
    if (!part.HasNormals()) return Eigen::Vector3d::Zero();
    const Eigen::Vector3d normal = matrix * vector_of(part.mNormals[i]);
    const double length = normal.norm();
    if (!(length > 0) || !std::isfinite(length)) return Eigen::Vector3d::Zero();
    return normal / length;
  }

  Eigen::Vector2d uv_of(const aiMesh& part, unsigned i, unsigned channel) const {
    if (!part.HasTextureCoords(channel)) return Eigen::Vector2d::Zero();
    const Eigen::Vector2d uv = vector_of(part.mTextureCoords[channel][i]).head<2>();
    if (!uv.allFinite())
      throw InputError(source_name_,
                       fmt::format("texture coordinate of vertex {} is not finite", i));
    return uv;
  }

  /// Vertex colours are 8-bit sRGB in every format that has them but glTF, where factor and colour
  /// are linear; there they are rare and read the same.
  static double colour_of(const aiMesh& part, unsigned i, const Material& material) {
    if (!part.HasVertexColors(0)) return material.albedo;
    const aiColor4D& c = part.mColors[0][i];
    const auto linear = [](float x) {
      return static_cast<float>(linear_from_srgb(std::clamp(x, 0.0F, 1.0F)));
    };
    return luminance(linear(c.r), linear(c.g), linear(c.b));
  }

  [[nodiscard]] std::string material_name(const aiMesh& part) const {
    return scene_.mMaterials[part.mMaterialIndex]->GetName().C_Str();
  }

  const aiScene& scene_;
  std::vector<ImportedMaterial> materials_;
  std::string source_name_;
  Mesh mesh_;
};

}  // namespace

Mesh MeshImporter::read_relief(const FileLocation& location, const FileSource& source) {
  const std::string source_name = location.text();
  if (!location.archive.empty())
    throw InputError(source_name, "relief parameters cannot be read from within an archive");
  const ReliefOptions options = read_relief_options(location.file);
  if (!options.texture) return generate_relief(options);
  const WrapModes wrap{Wrap::kClamp, Wrap::kClamp};
  return generate_relief(options,
                         textures_.colour(source, *options.texture, wrap, source_name).grey);
}

Mesh MeshImporter::read(const fs::path& file) {
  const std::string problem = missing_file_problem(file);
  if (!problem.empty()) throw InputError(file.string(), problem);
  const FileLocation location = FileLocation::parse(file);
  const FileSource& source = sources_.try_emplace(location.archive, location.archive).first->second;
  const std::string source_name = location.text();
  if (!source.contains(location.file)) throw InputError(source_name, "is not in this archive");
  if (source_name.ends_with(".relief.yaml")) return read_relief(location, source);

  Assimp::Importer importer;  // owns the AssimpFiles
  const aiScene& scene = load(importer, new AssimpFiles(source), location.file, source_name);
  const MaterialContext context{scene, source, location.file, source_name, textures_};
  Flattener flattener(scene, used_materials(context), source_name);
  flattener.add(*scene.mRootNode, Eigen::Affine3d::Identity());
  return flattener.take();
}

}  // namespace saccade
