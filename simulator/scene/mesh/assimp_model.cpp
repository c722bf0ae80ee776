#include "simulator/scene/mesh/assimp_model.h"

#include <assimp/GltfMaterial.h>
#include <assimp/config.h>
#include <assimp/material.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>
#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <assimp/Importer.hpp>
#include <cmath>
#include <cstring>
#include <map>
#include <new>
#include <stdexcept>

namespace saccade {
namespace {

namespace fs = std::filesystem;

constexpr float kSmoothingAngleDeg = 40;

bool has_uv_transforms(const aiScene& scene) {
  for (unsigned i = 0; i < scene.mNumMaterials; ++i)
    for (unsigned k = 0; k < scene.mMaterials[i]->mNumProperties; ++k)
      if (std::strcmp(scene.mMaterials[i]->mProperties[k]->mKey.C_Str(),
                      _AI_MATKEY_UVTRANSFORM_BASE) == 0)
        return true;
  return false;
}

/// Groups and lights of some files are meshes without faces, which assimp takes for an error when it
/// sorts by primitives. As points they are left out.
void leave_out_empty_meshes(aiScene& scene) {
  for (unsigned i = 0; i < scene.mNumMeshes; ++i)
    if (scene.mMeshes[i]->mPrimitiveTypes == 0)
      scene.mMeshes[i]->mPrimitiveTypes = aiPrimitiveType_POINT;
}

/// In the child, where errors are words.
const aiScene& load(Assimp::Importer& importer, AssimpFiles* files, const fs::path& file) {
  importer.SetIOHandler(files);
  importer.SetPropertyInteger(AI_CONFIG_PP_SBP_REMOVE,
                              aiPrimitiveType_POINT | aiPrimitiveType_LINE);
  importer.SetPropertyFloat(AI_CONFIG_PP_GSN_MAX_SMOOTHING_ANGLE, kSmoothingAngleDeg);
  importer.SetPropertyBool(AI_CONFIG_IMPORT_COLLADA_IGNORE_UP_DIRECTION, true);
  const aiScene* scene = importer.ReadFile(file.generic_string(), 0);
  if (scene != nullptr && scene->mRootNode == nullptr)
    throw std::runtime_error("holds no scene: no node is its root");
  if (scene != nullptr) {
    leave_out_empty_meshes(*const_cast<aiScene*>(scene));  // the importer's, that nobody else sees
    scene = importer.ApplyPostProcessing(aiProcess_Triangulate | aiProcess_GenSmoothNormals |
                                         aiProcess_SortByPType);
  }
  for (const std::string& missing : files->missing())
    if (missing.ends_with(".mtl") &&
        std::ranges::none_of(files->opened(), [](const auto& f) { return f.ends_with(".mtl"); }))
      throw std::runtime_error(fmt::format("its material library {} does not exist",
                                           fs::path(missing).lexically_normal().string()));
  if (scene == nullptr) {
    const std::string text = importer.GetErrorString();
    if (text.find("bad_alloc") != std::string::npos) throw std::bad_alloc();
    throw std::runtime_error("cannot be read as a mesh: " + text);
  }
  if (has_uv_transforms(*scene)) scene = importer.ApplyPostProcessing(aiProcess_TransformUVCoords);
  if (scene == nullptr || scene->mRootNode == nullptr)
    throw std::runtime_error("holds no visible triangle");
  return *scene;
}

Wrap wrap_of(int mode) {
  if (mode == aiTextureMapMode_Mirror) return Wrap::kMirror;
  return mode == aiTextureMapMode_Wrap ? Wrap::kRepeat : Wrap::kClamp;
}

std::int32_t embedded_index(const aiScene& scene, const char* name) {
  const aiTexture* embedded = scene.GetEmbeddedTexture(name);
  for (unsigned i = 0; embedded != nullptr && i < scene.mNumTextures; ++i)
    if (scene.mTextures[i] == embedded) return static_cast<std::int32_t>(i);
  return -1;
}

std::optional<ModelTexture> find_texture(const aiScene& scene, const aiMaterial& material,
                                         aiTextureType type) {
  aiString name;
  if (material.GetTexture(type, 0, &name) != aiReturn_SUCCESS || name.length == 0)
    return std::nullopt;
  ModelTexture reference{name.C_Str(), {}, 0, embedded_index(scene, name.C_Str())};
  int mode = aiTextureMapMode_Wrap;
  if (material.Get(AI_MATKEY_MAPPINGMODE_U(type, 0), mode) == aiReturn_SUCCESS)
    reference.wrap.u = wrap_of(mode);
  if (material.Get(AI_MATKEY_MAPPINGMODE_V(type, 0), mode) == aiReturn_SUCCESS)
    reference.wrap.v = wrap_of(mode);
  int channel = 0;
  if (material.Get(AI_MATKEY_UVWSRC(type, 0), channel) == aiReturn_SUCCESS && channel >= 0)
    reference.uv_channel = static_cast<std::uint32_t>(channel);
  return reference;
}

/// Bump maps of OBJ are heights to assimp.
constexpr struct {
  aiTextureType type;
  const char* feature;
} kIgnoredTextures[] = {
    {aiTextureType_HEIGHT, "bump maps"},
    {aiTextureType_EMISSIVE, "emission"},
    {aiTextureType_SPECULAR, "specular reflection"},
    {aiTextureType_LIGHTMAP, "light maps"},
    {aiTextureType_REFLECTION, "mirror reflection"},
};

std::vector<std::string> ignored_features(const aiMaterial& material) {
  std::vector<std::string> features;
  for (const auto& [type, feature] : kIgnoredTextures)
    if (material.GetTextureCount(type) > 0) features.emplace_back(feature);
  aiColor3D emission(0, 0, 0);
  material.Get(AI_MATKEY_COLOR_EMISSIVE, emission);
  if (!emission.IsBlack() && material.GetTextureCount(aiTextureType_EMISSIVE) == 0)
    features.emplace_back("emission");
  return features;
}

ModelMaterial material_of(const aiScene& scene, const aiMaterial& material) {
  ModelMaterial result;
  result.name = material.GetName().C_Str();
  // Only glTF states an alpha mode, and defines its colours in linear light.
  aiString mode;
  result.is_linear = material.Get(AI_MATKEY_GLTF_ALPHAMODE, mode) == aiReturn_SUCCESS;
  result.ignores_alpha = result.is_linear && std::strcmp(mode.C_Str(), "OPAQUE") == 0;
  aiColor3D colour(0.5F, 0.5F, 0.5F);
  material.Get(AI_MATKEY_COLOR_DIFFUSE, colour);
  result.colour = {colour.r, colour.g, colour.b};
  material.Get(AI_MATKEY_OPACITY, result.opacity);
  result.colour_texture = find_texture(scene, material, aiTextureType_DIFFUSE);
  if (!result.colour_texture)
    result.colour_texture = find_texture(scene, material, aiTextureType_BASE_COLOR);
  result.opacity_texture = find_texture(scene, material, aiTextureType_OPACITY);
  result.normal_texture = find_texture(scene, material, aiTextureType_NORMALS);
  result.ignored = ignored_features(material);
  return result;
}

ModelPicture picture_of(const aiTexture& texture) {
  ModelPicture picture;
  picture.hint = texture.achFormatHint;
  std::size_t size = texture.mWidth;
  if (texture.mHeight != 0) {
    picture.width = texture.mWidth;
    picture.height = texture.mHeight;
    size = std::size_t{texture.mWidth} * texture.mHeight * sizeof(aiTexel);
  }
  const auto* bytes = reinterpret_cast<const std::uint8_t*>(texture.pcData);
  if (bytes != nullptr) picture.bytes.assign(bytes, bytes + size);
  return picture;
}

std::array<float, 3> floats_of(const aiVector3D& v) {
  return {static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z)};
}

ModelPart part_of(const aiMesh& mesh) {
  ModelPart part;
  part.material = mesh.mMaterialIndex;
  const unsigned n = mesh.mVertices != nullptr ? mesh.mNumVertices : 0;
  part.vertices.reserve(n);
  part.normals.reserve(n);
  part.triangles.reserve(mesh.mNumFaces);
  for (unsigned i = 0; i < n; ++i) part.vertices.push_back(floats_of(mesh.mVertices[i]));
  for (unsigned i = 0; mesh.HasNormals() && i < n; ++i)
    part.normals.push_back(floats_of(mesh.mNormals[i]));
  for (unsigned channel = 0; channel < AI_MAX_NUMBER_OF_TEXTURECOORDS; ++channel) {
    part.uvs.emplace_back();
    for (unsigned i = 0; mesh.HasTextureCoords(channel) && i < n; ++i) {
      const std::array<float, 3> uvw = floats_of(mesh.mTextureCoords[channel][i]);
      part.uvs.back().push_back({uvw[0], uvw[1]});
    }
  }
  for (unsigned i = 0; mesh.HasVertexColors(0) && i < n; ++i) {
    const aiColor4D& colour = mesh.mColors[0][i];
    part.colours.push_back({colour.r, colour.g, colour.b, colour.a});
  }
  for (unsigned i = 0; mesh.HasNormals() && mesh.HasTangentsAndBitangents() && i < n; ++i) {
    const aiVector3D& tangent = mesh.mTangents[i];
    const bool is_left = (mesh.mNormals[i] ^ tangent) * mesh.mBitangents[i] < 0;
    part.tangents.push_back({static_cast<float>(tangent.x), static_cast<float>(tangent.y),
                             static_cast<float>(tangent.z), is_left ? -1.0F : 1.0F});
  }
  for (unsigned i = 0; i < mesh.mNumFaces; ++i) {
    const aiFace& face = mesh.mFaces[i];
    if (face.mNumIndices == 3)
      part.triangles.push_back({face.mIndices[0], face.mIndices[1], face.mIndices[2]});
  }
  return part;
}

/// By column, as models have them.
std::array<double, 16> columns_of(const aiMatrix4x4& m) {
  const auto d = [](ai_real value) { return static_cast<double>(value); };
  return {d(m.a1), d(m.b1), d(m.c1), d(m.d1), d(m.a2), d(m.b2), d(m.c2), d(m.d2),
          d(m.a3), d(m.b3), d(m.c3), d(m.d3), d(m.a4), d(m.b4), d(m.c4), d(m.d4)};
}

std::array<double, 3> doubles_of(const aiVector3D& v) {
  return {static_cast<double>(v.x), static_cast<double>(v.y), static_cast<double>(v.z)};
}

/// Appends a node and all below it, parents first.
void add_nodes(const aiNode& node, std::int32_t parent, const Eigen::Affine3d& file_from_parent,
               Model& model) {
  ModelNode& added = model.tree.emplace_back();
  added.name = node.mName.C_Str();
  added.parent = parent;
  added.parent_from_node = columns_of(node.mTransformation);
  const auto index = static_cast<std::uint32_t>(model.tree.size() - 1);
  const Eigen::Affine3d file_from_node =
      file_from_parent *
      Eigen::Affine3d(Eigen::Map<const Eigen::Matrix4d>(added.parent_from_node.data()));
  if (node.mNumMeshes > 0) model.nodes.emplace_back(node.mName.C_Str());
  for (unsigned i = 0; i < node.mNumMeshes; ++i) {
    ModelInstance& instance = model.instances.emplace_back();
    instance.node = static_cast<std::uint32_t>(model.nodes.size() - 1);
    instance.tree_node = index;
    instance.part = node.mMeshes[i];
    std::copy_n(file_from_node.matrix().data(), instance.file_from_part.size(),
                instance.file_from_part.begin());
  }
  for (unsigned i = 0; i < node.mNumChildren; ++i)
    add_nodes(*node.mChildren[i], static_cast<std::int32_t>(index), file_from_node, model);
}

/// Nodes of a model by name; the first one of those that share it.
class NodeIndex {
 public:
  explicit NodeIndex(const Model& model) {
    for (std::size_t i = 0; i < model.tree.size(); ++i)
      indices_.try_emplace(model.tree[i].name, static_cast<std::int32_t>(i));
  }
  [[nodiscard]] std::int32_t of(const aiString& name) const {
    const auto found = indices_.find(name.C_Str());
    return found == indices_.end() ? -1 : found->second;
  }

 private:
  std::map<std::string, std::int32_t> indices_;
};

void add_bones(const aiMesh& mesh, const NodeIndex& nodes, ModelPart& part) {
  for (unsigned i = 0; i < mesh.mNumBones; ++i) {
    const aiBone& bone = *mesh.mBones[i];
    ModelBone& added = part.bones.emplace_back();
    added.name = bone.mName.C_Str();
    added.node = nodes.of(bone.mName);
    added.bone_from_part = columns_of(bone.mOffsetMatrix);
    for (unsigned k = 0; k < bone.mNumWeights; ++k) {
      added.vertices.push_back(bone.mWeights[k].mVertexId);
      added.weights.push_back(static_cast<float>(bone.mWeights[k].mWeight));
    }
  }
}

ModelCamera camera_of(const aiCamera& camera, const NodeIndex& nodes) {
  ModelCamera result{.name = camera.mName.C_Str(),
                     .node = nodes.of(camera.mName),
                     .position = doubles_of(camera.mPosition),
                     .forward = doubles_of(camera.mLookAt),
                     .up = doubles_of(camera.mUp),
                     .horizontal_fov_rad = static_cast<double>(camera.mHorizontalFOV)};
  if (camera.mAspect > 0)
    result.vertical_fov_rad = 2 * std::atan(std::tan(0.5 * result.horizontal_fov_rad) /
                                            static_cast<double>(camera.mAspect));
  return result;
}

/// The keys of one kind in seconds. `numbers`: those of a key's value.
template <class Key, class Numbers>
ModelTrack track_of(const Key* keys, unsigned count, double ticks_per_s, const Numbers& numbers) {
  ModelTrack track;
  for (unsigned i = 0; i < count; ++i) {
    track.times_s.push_back(keys[i].mTime / ticks_per_s);
    for (const auto value : numbers(keys[i].mValue))
      track.values.push_back(static_cast<double>(value));
  }
  return track;
}

ModelAnimation animation_of(const aiAnimation& animation, const NodeIndex& nodes) {
  constexpr double kUsualTicks_per_s = 25;  // what formats mean that state none
  const double ticks_per_s =
      animation.mTicksPerSecond > 0 ? animation.mTicksPerSecond : kUsualTicks_per_s;
  ModelAnimation result{animation.mName.C_Str(), animation.mDuration / ticks_per_s, {}};
  const auto vector = [](const aiVector3D& v) { return std::array{v.x, v.y, v.z}; };
  const auto rotation = [](const aiQuaternion& q) { return std::array{q.x, q.y, q.z, q.w}; };
  for (unsigned i = 0; i < animation.mNumChannels; ++i) {
    const aiNodeAnim& channel = *animation.mChannels[i];
    const std::int32_t node = nodes.of(channel.mNodeName);
    if (node < 0) continue;  // of a light, or of what was left out
    result.channels.push_back(
        {static_cast<std::uint32_t>(node),
         track_of(channel.mPositionKeys, channel.mNumPositionKeys, ticks_per_s, vector),
         track_of(channel.mRotationKeys, channel.mNumRotationKeys, ticks_per_s, rotation),
         track_of(channel.mScalingKeys, channel.mNumScalingKeys, ticks_per_s, vector)});
  }
  return result;
}

Model model_of(const aiScene& scene) {
  Model model;
  add_nodes(*scene.mRootNode, -1, Eigen::Affine3d::Identity(), model);
  const NodeIndex nodes(model);
  for (unsigned i = 0; i < scene.mNumMaterials; ++i)
    model.materials.push_back(material_of(scene, *scene.mMaterials[i]));
  for (unsigned i = 0; i < scene.mNumMeshes; ++i) {
    model.parts.push_back(part_of(*scene.mMeshes[i]));
    add_bones(*scene.mMeshes[i], nodes, model.parts.back());
  }
  for (unsigned i = 0; i < scene.mNumTextures; ++i)
    model.pictures.push_back(picture_of(*scene.mTextures[i]));
  for (unsigned i = 0; i < scene.mNumCameras; ++i)
    model.cameras.push_back(camera_of(*scene.mCameras[i], nodes));
  for (unsigned i = 0; i < scene.mNumAnimations; ++i)
    model.animations.push_back(animation_of(*scene.mAnimations[i], nodes));
  model.lights = scene.mNumLights;
  return model;
}

}  // namespace

Model read_through_assimp(const FileSource& source, const std::filesystem::path& file,
                          const ReplacedFiles& replaced) {
  Assimp::Importer importer;  // owns the AssimpFiles
  auto* const files = new AssimpFiles(source, replaced);
  Model model = model_of(load(importer, files, file));
  model.opened = files->opened();
  return model;
}

bool is_assimp_format(const std::string& extension) {
  return Assimp::Importer().IsExtensionSupported(extension);
}

}  // namespace saccade
