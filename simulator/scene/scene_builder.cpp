#include "simulator/scene/scene_builder.h"

#include <fmt/format.h>

#include <map>
#include <utility>

#include "core/check.h"
#include "core/error.h"
#include "simulator/scene/mesh_import.h"
#include "simulator/scene/picture.h"
#include "simulator/scene/placement.h"
#include "simulator/scene/triangle_setup.h"

namespace saccade {
namespace {

/// Shadow rays start this share of the scene's diagonal above their surface: ten times what single
/// precision resolves there.
constexpr double kShadowOffset = 1e-6;

double diagonal(const std::vector<Corners>& triangles) {
  Eigen::AlignedBox3f box;
  for (const Corners& corners : triangles)
    for (const Eigen::Vector3f& corner : corners) box.extend(corner);
  return box.diagonal().norm() + box.center().norm();
}

Background read_background(const SceneOptions& options) {
  if (options.background_picture.empty()) return Background(options.background);
  const FileLocation location = FileLocation::parse(options.background_picture);
  const std::optional<Bytes> bytes = FileSource(location.archive).read(location.file);
  if (!bytes) throw InputError(location.text(), "this background picture does not exist");
  return Background(decode_picture(*bytes, location.text()).grey);
}

}  // namespace

SceneBuilder::SceneBuilder()
    : opaque_(std::make_unique<PreparedTriangles>()),
      cut_out_(std::make_unique<PreparedTriangles>()) {}
SceneBuilder::~SceneBuilder() = default;

std::size_t SceneBuilder::add(const Mesh& mesh, const Eigen::Affine3d& world_from_mesh) {
  const TriangleSetup setup(mesh, world_from_mesh, objects_++);
  for (const Material& material : mesh.materials) {
    textures_.push_back(material.texture);
    textures_.push_back(material.opacity);
  }
  std::size_t kept = 0;
  for (const Triangle& triangle : mesh.triangles) {
    const bool is_cut_out = mesh.materials[triangle.material].opacity != nullptr;
    kept += setup.add(triangle, is_cut_out ? *cut_out_ : *opaque_) ? 1 : 0;
  }
  return kept;
}

void SceneBuilder::light(double ambient, std::vector<LightOptions> lights) {
  is_lit_ = true;
  ambient_ = ambient;
  lights_ = std::move(lights);
}

Scene SceneBuilder::build(const Background& background) && {
  auto state = std::make_unique<Scene::State>();
  const std::size_t opaque = opaque_->corners.size();
  PreparedTriangles all = std::move(*opaque_);
  all.append(*cut_out_);
  SACCADE_CHECK(!all.corners.empty());
  if (is_lit_) {
    state->illumination.emplace(ambient_, lights_, kShadowOffset * diagonal(all.corners));
    state->normals = std::move(all.normals);
  }
  state->surfaces = std::move(all.surfaces);
  state->interiors = std::move(all.interiors);
  state->cutouts = std::move(all.cutouts);
  state->textures = std::move(textures_);
  state->background = background;
  state->caster.emplace(all.corners, opaque,
                        [scene = state.get()](const Ray& ray, TriangleId triangle) {
                          return scene->is_opaque(ray, triangle);
                        });
  return Scene(std::move(state));
}

Scene build_scene(const SceneOptions& options) {
  SceneBuilder builder;
  MeshImporter importer;
  std::map<std::filesystem::path, Mesh> meshes;
  for (const MeshOptions& item : options.meshes) {
    auto known = meshes.find(item.file);
    if (known == meshes.end()) known = meshes.emplace(item.file, importer.read(item.file)).first;
    const Mesh& mesh = known->second;
    if (builder.add(mesh, world_from_mesh(item, mesh)) == 0)
      throw InputError(item.file.string(), "none of its triangles has an area");
  }
  if (options.meshes.empty()) throw InputError("scene.meshes", "names no mesh");
  if (options.lighting == Lighting::kLambertian) builder.light(options.ambient, options.lights);
  return std::move(builder).build(read_background(options));
}

}  // namespace saccade
