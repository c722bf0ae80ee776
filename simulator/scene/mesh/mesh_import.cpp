#include "simulator/scene/mesh/mesh_import.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "core/check.h"
#include "core/error.h"
#include "core/srgb.h"
#include "simulator/scene/animation/animation_sampler.h"
#include "simulator/scene/animation/gltf_motion.h"
#include "simulator/scene/animation/node_animation.h"
#include "simulator/scene/mesh/ac3d_file.h"
#include "simulator/scene/mesh/gltf_file.h"
#include "simulator/scene/mesh/gltf_lights.h"
#include "simulator/scene/mesh/gltf_material.h"
#include "simulator/scene/mesh/model_import.h"
#include "simulator/scene/mesh/quake3/quake3_map.h"
#include "simulator/scene/mesh/quake3/quake3_material.h"
#include "simulator/scene/mesh/relief.h"

namespace saccade {
namespace {

namespace fs = std::filesystem;

/// Reads material k of a model, or where there is none, a default.
using ReadMaterial = std::function<ImportedMaterial(std::size_t)>;

/// Libraries hold materials, with textures, that no face uses; those stay empty.
std::vector<ImportedMaterial> used_materials(const Model& model, const ReadMaterial& read) {
  std::vector<ImportedMaterial> materials(model.materials.size());
  std::vector<bool> done(materials.size());
  for (const ModelPart& part : model.parts) {
    if (!done[part.material]) materials[part.material] = read(part.material);
    done[part.material] = true;
  }
  return materials;
}

/// The materials of a glTF file are named by their index (GltfFile::for_assimp()).
std::size_t gltf_index(const ModelMaterial& material, const GltfFile& file) {
  constexpr std::size_t kNoIndex = static_cast<std::size_t>(-1);
  for (std::size_t i = 0; file.item("materials", i).is_object(); ++i)
    if (material.name == std::to_string(i)) return i;
  return kNoIndex;
}

/// Whether a part's colours state opacities. assimp leaves those of colours without one at zero.
bool has_opacities(const ModelPart& part) {
  const auto opacity = [](const auto& colour) { return colour[3]; };
  return std::ranges::any_of(
             part.colours, [](float a) { return a < 1; }, opacity) &&
         std::ranges::any_of(
             part.colours, [](float a) { return a > 0; }, opacity);
}

Eigen::Vector3d vector_of(const std::array<float, 3>& v) {
  return {static_cast<double>(v[0]), static_cast<double>(v[1]), static_cast<double>(v[2])};
}

/// Copies the parts of a model into one mesh.
class Flattener {
 public:
  Flattener(const Model& model, std::vector<ImportedMaterial> materials, ColourChannel channel,
            std::string source_name, SceneRemarks& remarks)
      : model_(model),
        materials_(std::move(materials)),
        channel_(channel),
        source_name_(std::move(source_name)),
        remarks_(remarks) {
    for (const ImportedMaterial& imported : materials_) {
      mesh_.materials.push_back(imported.material);
      has_normal_maps_ = has_normal_maps_ || imported.material.normal_map != nullptr;
    }
  }

  void add(const ModelInstance& instance) {
    const ModelPart& part = model_.parts[instance.part];
    const Eigen::Affine3d file_from_part(
        Eigen::Map<const Eigen::Matrix4d>(instance.file_from_part.data()));
    const ImportedMaterial& imported = materials_[part.material];
    const Material& material = imported.material;
    const bool textured = material.texture != nullptr || material.opacity != nullptr;
    if (!imported.invisible && textured && !has_uvs(part, imported.uv_channel))
      throw InputError(source_name_,
                       fmt::format("material '{}' has a texture, but its faces have no "
                                   "texture coordinates",
                                   model_.materials[part.material].name));
    if (!imported.invisible && material.normal_map && !has_uvs(part, imported.normal_uv_channel))
      throw InputError(source_name_,
                       fmt::format("material '{}' has a normal map, but its faces have no "
                                   "texture coordinates for it",
                                   model_.materials[part.material].name));
    const std::size_t first = mesh_.vertices.size();
    const Eigen::Matrix3d normal_matrix = file_from_part.linear().inverse().transpose();
    for (std::size_t i = 0; i < part.vertices.size(); ++i) {
      mesh_.vertices.push_back(file_from_part * vector_of(part.vertices[i]));
      check_finite(mesh_.vertices.back(), first + i);
      mesh_.normals.push_back(normal_of(part, i, normal_matrix));
      mesh_.uvs.push_back(uv_of(part, i, imported.uv_channel, imported.uv_transform));
      if (has_normal_maps_) {
        mesh_.normal_uvs.push_back(
            uv_of(part, i, imported.normal_uv_channel, imported.normal_uv_transform));
        mesh_.tangents.push_back(tangent_of(part, i, imported, file_from_part.linear()));
      }
      mesh_.colours.push_back(colour_of(part, i, imported));
    }
    if (has_opacities(part)) remarks_.ignore("opacity of vertices", source_name_);
    // Vertices stay in any case: a model's size is that of all its parts.
    if (!imported.invisible) add_faces(part, static_cast<std::uint32_t>(first), instance.node);
  }

  [[nodiscard]] Mesh take() {
    if (mesh_.triangles.empty()) throw InputError(source_name_, "holds no visible triangle");
    return std::move(mesh_);
  }

 private:
  static bool has_uvs(const ModelPart& part, std::size_t channel) {
    return channel < part.uvs.size() && !part.uvs[channel].empty();
  }

  void add_faces(const ModelPart& part, std::uint32_t first, std::uint32_t node) {
    const std::uint32_t material = coloured_material(part);
    for (const auto& [a, b, c] : part.triangles)
      mesh_.triangles.push_back({{first + a, first + b, first + c}, material, node});
  }

  /// Linear vertex colours multiply a texture as well. The factor of a material does that where
  /// they are all the same.
  std::uint32_t coloured_material(const ModelPart& part) {
    const ImportedMaterial& imported = materials_[part.material];
    if (!imported.colour || part.colours.empty()) return part.material;
    if (imported.material.texture == nullptr) {
      if (imported.material.self_light > 0)
        remarks_.ignore("vertex colours that leave emission as it is, under lights", source_name_);
      return part.material;
    }
    const std::array<float, 4>& first = part.colours.front();
    const bool is_uniform = std::ranges::all_of(part.colours, [&first](const auto& colour) {
      return std::equal(colour.begin(), colour.begin() + 3, first.begin());
    });
    const auto& [r, g, b, a] = first;
    if (is_uniform && r == 1 && g == 1 && b == 1) return part.material;
    if (!is_uniform || imported.emission > 0 || imported.material.self_light > 0) {
      remarks_.ignore("vertex colours over textures", source_name_);
      return part.material;
    }
    mesh_.materials.push_back(imported.material);
    mesh_.materials.back().factor *= grey_of({r, g, b}, channel_);
    return static_cast<std::uint32_t>(mesh_.materials.size() - 1);
  }

  void check_finite(const Eigen::Vector3d& vertex, std::size_t index) const {
    if (!vertex.allFinite())
      throw InputError(source_name_, fmt::format("vertex {} is not finite", index));
  }

  static Eigen::Vector3d normal_of(const ModelPart& part, std::size_t i,
                                   const Eigen::Matrix3d& matrix) {
    if (part.normals.empty()) return Eigen::Vector3d::Zero();
    const Eigen::Vector3d normal = matrix * vector_of(part.normals[i]);
    const double length = normal.norm();
    if (!(length > 0) || !std::isfinite(length)) return Eigen::Vector3d::Zero();
    return normal / length;
  }

  /// A transform of the texture's coordinates may turn them: then those that are stated do not count.
  static Eigen::Vector4d tangent_of(const ModelPart& part, std::size_t i,
                                    const ImportedMaterial& imported,
                                    const Eigen::Matrix3d& file_from_part) {
    if (part.tangents.empty() || imported.normal_uv_transform) return Eigen::Vector4d::Zero();
    const auto& [x, y, z, w] = part.tangents[i];
    const Eigen::Vector3d tangent = file_from_part * vector_of({x, y, z});
    const double length = tangent.norm();
    if (!(length > 0) || !std::isfinite(length)) return Eigen::Vector4d::Zero();
    Eigen::Vector4d result;
    result << tangent / length, (w < 0) != (file_from_part.determinant() < 0) ? -1.0 : 1.0;
    return result;
  }

  Eigen::Vector2d uv_of(const ModelPart& part, std::size_t i, std::uint32_t channel,
                        const std::optional<Eigen::Affine2d>& transform) const {
    if (!has_uvs(part, channel)) return Eigen::Vector2d::Zero();
    const auto& [u, v] = part.uvs[channel][i];
    Eigen::Vector2d uv(static_cast<double>(u), static_cast<double>(v));
    if (transform) uv = *transform * uv;
    if (!uv.allFinite())
      throw InputError(source_name_,
                       fmt::format("texture coordinate of vertex {} is not finite", i));
    return uv;
  }

  /// Vertex colours are 8-bit sRGB in every format that has them but glTF.
  double colour_of(const ModelPart& part, std::size_t i, const ImportedMaterial& imported) const {
    if (part.colours.empty()) return imported.material.albedo;
    const auto& [r, g, b, a] = part.colours[i];
    if (const auto& factor = imported.colour)
      return grey_of({(*factor)[0] * r, (*factor)[1] * g, (*factor)[2] * b}, channel_) +
             imported.emission;
    const auto linear = [](float x) {
      return static_cast<float>(linear_from_srgb(std::clamp(x, 0.0F, 1.0F)));
    };
    return in_channel(channel_, linear(r), linear(g), linear(b));
  }

  const Model& model_;
  std::vector<ImportedMaterial> materials_;
  ColourChannel channel_;
  std::string source_name_;
  SceneRemarks& remarks_;
  bool has_normal_maps_ = false;
  Mesh mesh_;
};

bool is_relief(const fs::path& file) { return file.string().ends_with(".relief.yaml"); }

std::size_t gltf_length(const nlohmann::json& list) { return list.is_array() ? list.size() : 0; }

/// assimp sees a glTF file without lights (GltfFile::for_assimp()).
MeshExtras extras_of(const Model& model, const std::optional<GltfFile>& gltf) {
  MeshExtras extras;
  extras.parts = model.parts.size();
  extras.instances = model.instances.size();
  extras.lights = model.lights;
  if (gltf) {
    const nlohmann::json& document = gltf->document();
    const nlohmann::json::json_pointer lights("/extensions/KHR_lights_punctual/lights");
    extras.lights = document.contains(lights) ? gltf_length(document.at(lights)) : 0;
  }
  return extras;
}

/// Poses the mesh of a model by its animation, with the first pose as its own.
void animate(const Model& model, const std::string& name, const std::string& source_name,
             SceneRemarks& remarks, Mesh& mesh) {
  const ModelAnimation& animation = find_animation(model.animations, name, source_name);
  auto poses = std::make_shared<MeshAnimation>(sample_animation(model, animation, source_name));
  SACCADE_CHECK(poses->vertices.front().size() == mesh.vertices.size());
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
    mesh.vertices[i] = poses->vertices.front()[i].cast<double>();
    mesh.normals[i] = poses->normals.front()[i].cast<double>();
  }
  if (poses->has_scaled_weights)
    remarks.say(source_name + ": weights of its bones do not sum to one, and are scaled to do so");
  mesh.animation = std::move(poses);
}

}  // namespace

MeshImporter::MeshImporter(const MeshImportOptions& options)
    : options_(options), textures_(options.missing_texture, remarks_, options.channel) {}

void MeshImporter::prefetch(const std::vector<fs::path>& files) {
  std::vector<fs::path> models;
  for (const fs::path& file : files)
    if (!is_relief(file)) models.push_back(file);
  imports_.reset();
  imports_.emplace(std::move(models));
}

Model MeshImporter::read_model(const fs::path& file, const FileSource& source,
                               const std::optional<GltfFile>& gltf, bool is_moving) {
  const FileLocation location = FileLocation::parse(file);
  const std::string source_name = location.text();
  check_model_format(location.file, source_name);
  if (gltf && is_moving) {
    Model model = import_model(source, location.file, source_name,
                               gltf->for_assimp(GltfFile::Stillness::kMoving));
    take_gltf_motion(*gltf, model);
    return model;
  }
  if (imports_)
    if (const std::optional<ForkedResult> result = imports_->take(file))
      return model_of(*result, location.file, source_name);
  return import_model(source, location.file, source_name,
                      gltf ? gltf->for_assimp() : ac3d_for_assimp(source, location.file));
}

Mesh MeshImporter::read_relief(const FileLocation& location, const FileSource& source) {
  const std::string source_name = location.text();
  if (!location.archive.empty())
    throw InputError(source_name, "relief parameters cannot be read from within an archive");
  const ReliefOptions options = read_relief_options(location.file);
  if (!options.texture) return generate_relief(options);
  const Wrap mode = options.texture_size_m ? Wrap::kRepeat : Wrap::kClamp;
  const WrapModes wrap{mode, mode};
  return generate_relief(options,
                         textures_.colour(source, *options.texture, wrap, source_name).grey);
}

Mesh MeshImporter::with_surface(Mesh mesh, const MeshSurface& surface, const std::string& user) {
  if (surface.texture) {
    if (std::ranges::all_of(mesh.uvs, [](const Eigen::Vector2d& uv) { return uv.isZero(); }))
      throw InputError(user, "has no texture coordinates for the 'texture' that the scene states");
    const FileLocation location = FileLocation::parse(*surface.texture);
    const FileSource& source =
        sources_.try_emplace(location.archive, location.archive).first->second;
    const TexturePair pair =
        textures_.colour(source, location.file, {}, user, surface.texture_seed);
    for (Material& material : mesh.materials) {
      material.texture = pair.grey;
      material.factor = 1;
      if (pair.grey == nullptr) material.albedo = 0.5;
    }
    if (pair.grey == nullptr) mesh.colours.clear();
  }
  for (Material& material : mesh.materials) {
    material.albedo *= surface.reflectance;
    material.factor *= surface.reflectance;
    if (surface.gloss) material.gloss = *surface.gloss;
  }
  for (double& colour : mesh.colours) colour *= surface.reflectance;
  return mesh;
}

Mesh MeshImporter::read(const fs::path& file, const std::optional<std::string>& animation) {
  const std::string problem = missing_file_problem(file);
  if (!problem.empty()) throw InputError(file.string(), problem);
  const FileLocation location = FileLocation::parse(file);
  const FileSource& source = sources_.try_emplace(location.archive, location.archive).first->second;
  const std::string source_name = location.text();
  if (!source.contains(location.file)) throw InputError(source_name, "is not in this archive");
  if (is_relief(file)) {
    if (animation) throw InputError(source_name, "a relief has no animation");
    return read_relief(location, source);
  }

  const std::optional<GltfFile> gltf = GltfFile::open(source, location.file, source_name);
  const Model model = read_model(file, source, gltf, animation.has_value());
  // What the importer read in its own process is noted in the InputLog of this one.
  for (const std::string& opened : model.opened) static_cast<void>(source.read(opened));
  const MaterialContext context{source,    location.file, source_name,          options_,
                                textures_, remarks_,      animation.has_value()};
  ReadMaterial read_material = [&](std::size_t index) {
    return import_material(model, model.materials[index], context);
  };
  std::optional<Quake3Materials> map_materials;
  if (is_quake3_map(location.file)) {
    map_materials.emplace(context);
    read_material = [&](std::size_t index) { return map_materials->read(model.materials[index]); };
  }
  std::optional<GltfMaterials> gltf_materials;
  if (gltf) {
    gltf_materials.emplace(*gltf, context);
    gltf_materials->remark_ignored(animation.has_value());
    read_material = [&](std::size_t index) {
      return gltf_materials->read(gltf_index(model.materials[index], *gltf));
    };
  }
  if (!gltf) {
    if (!model.animations.empty() && !animation) remarks_.ignore("animations", source_name);
    if (model.lights > 0) remarks_.ignore("lights", source_name);
  }
  Flattener flattener(model, used_materials(model, read_material), options_.channel, source_name,
                      remarks_);
  for (const ModelInstance& instance : model.instances) flattener.add(instance);
  Mesh mesh = flattener.take();
  mesh.nodes = model.nodes;
  if (gltf && options_.takes_lights) mesh.lights = read_gltf_lights(*gltf, options_.channel);
  mesh.extras = extras_of(model, gltf);
  if (animation) animate(model, *animation, source_name, remarks_, mesh);
  return mesh;
}

}  // namespace saccade
