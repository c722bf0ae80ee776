#include "simulator/scene/scene_builder.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <map>
#include <memory>
#include <numeric>
#include <optional>
#include <string>
#include <utility>

#include "core/check.h"
#include "core/error.h"
#include "simulator/scene/light/area_light.h"
#include "simulator/scene/mesh/distinct_triangles.h"
#include "simulator/scene/triangle_setup.h"

namespace saccade {
namespace {

/// Shadow rays start this fraction of the largest body's extent above their surface: ten times what
/// single precision resolves there.
constexpr double kShadowOffset = 1e-6;

Eigen::AlignedBox3f box_of(const PreparedTriangles& triangles) {
  Eigen::AlignedBox3f box;
  for (const Corners& corners : triangles.corners)
    for (const Eigen::Vector3f& corner : corners) box.extend(corner);
  return box;
}

double extent_of(const Eigen::AlignedBox3f& box) {
  return static_cast<double>(box.diagonal().norm() + box.center().norm());
}

/// Corners are rounded to single precision, those of a plane lie on it: a hair of margin for both.
Eigen::AlignedBox3d roomy(const Eigen::AlignedBox3f& box) {
  constexpr double kMargin = 1e-5;
  const Eigen::AlignedBox3d exact = box.cast<double>();
  const Eigen::Vector3d margin = Eigen::Vector3d::Constant(kMargin * extent_of(box));
  return {exact.min() - margin, exact.max() + margin};
}

/// Numbers the instances of a mesh in the order in which their first triangles come.
class InstanceNumbers {
 public:
  InstanceNumbers(const InstanceLabel& label, const Mesh& mesh, std::uint32_t object,
                  std::vector<SceneInstance>& instances)
      : label_(label), mesh_(mesh), object_(object), instances_(instances) {}

  [[nodiscard]] std::uint16_t of(const Triangle& triangle) {
    const auto [known, is_new] =
        numbers_.try_emplace(label_.splits_nodes ? triangle.node : 0, std::uint16_t{0});
    if (is_new) known->second = append(triangle.node);
    return known->second;
  }

 private:
  std::uint16_t append(std::uint32_t node) {
    if (instances_.size() == kMaxInstances)
      throw InputError("scene.meshes", fmt::format("make more than {} instances", kMaxInstances));
    std::string name = label_.name;
    if (label_.splits_nodes && node < mesh_.nodes.size()) name += "/" + mesh_.nodes[node];
    instances_.push_back({name, label_.file, object_, label_.class_id});
    return static_cast<std::uint16_t>(instances_.size());
  }

  const InstanceLabel& label_;
  const Mesh& mesh_;
  std::uint32_t object_;
  std::vector<SceneInstance>& instances_;
  std::map<std::uint32_t, std::uint16_t> numbers_;  ///< of nodes, or of the whole mesh
};

}  // namespace

struct SceneBuilder::Body {
  std::optional<Spline> world_from_body;  ///< none: is static
  std::uint32_t object = 0;               ///< of a moving one
  std::shared_ptr<const VertexAnimation> animation;
  PreparedTriangles opaque, cut_out;
  TriangleId first_opaque = 0, first_cut_out = 0;

  [[nodiscard]] bool is_moving() const { return world_from_body || animation; }
  [[nodiscard]] bool is_empty() const {
    return opaque.corners.empty() && cut_out.corners.empty() && opaque.corner_indices.empty() &&
           cut_out.corner_indices.empty();
  }
  [[nodiscard]] Eigen::AlignedBox3f box() const {
    return animation ? animation->box() : box_of(opaque).merged(box_of(cut_out));
  }
  [[nodiscard]] AnimatedTriangles animated() const {
    return {opaque.corner_indices, cut_out.corner_indices, first_opaque, first_cut_out};
  }
  [[nodiscard]] BvhTriangles occluders() && {
    BvhTriangles source{std::move(opaque.corners), {}};
    source.ids.resize(source.corners.size() + cut_out.corners.size());
    const auto first = source.ids.begin() + static_cast<std::ptrdiff_t>(source.corners.size());
    std::iota(source.ids.begin(), first, first_opaque);
    std::iota(first, source.ids.end(), first_cut_out);
    source.corners.insert(source.corners.end(), cut_out.corners.begin(), cut_out.corners.end());
    return source;
  }
};

SceneBuilder::SceneBuilder() : bodies_(1) {}
SceneBuilder::~SceneBuilder() = default;

std::size_t SceneBuilder::add(const Mesh& mesh, const Eigen::Affine3d& world_from_mesh,
                              const InstanceLabel& label) {
  return add_to(bodies_.front(), mesh, world_from_mesh, label);
}

std::size_t SceneBuilder::add_moving(const Mesh& mesh, const Eigen::Affine3d& object_from_mesh,
                                     Spline world_from_object, const InstanceLabel& label) {
  Body body;
  body.world_from_body = std::move(world_from_object);
  body.object = objects_;
  const std::size_t kept = add_to(body, mesh, object_from_mesh, label);
  if (kept > 0) bodies_.push_back(std::move(body));
  return kept;
}

std::size_t SceneBuilder::add_animated(const Mesh& mesh, const Eigen::Affine3d& object_from_mesh,
                                       const AnimationOptions& animation,
                                       std::optional<Spline> world_from_object,
                                       const InstanceLabel& label) {
  SACCADE_CHECK(mesh.animation != nullptr);
  Body body;
  body.world_from_body = std::move(world_from_object);
  body.object = objects_;
  body.animation =
      std::make_shared<const VertexAnimation>(*mesh.animation, object_from_mesh, animation);
  const std::size_t kept = add_to(body, mesh, object_from_mesh, label);
  if (kept > 0) bodies_.push_back(std::move(body));
  return kept;
}

std::size_t SceneBuilder::add_to(Body& body, const Mesh& mesh,
                                 const Eigen::Affine3d& body_from_mesh,
                                 const InstanceLabel& label) {
  InstanceNumbers numbers(label, mesh, objects_, instances_);
  const TriangleSetup setup(mesh, body_from_mesh, objects_++);
  for (const Material& material : mesh.materials) {
    textures_.push_back(material.texture);
    textures_.push_back(material.opacity);
    if (material.normal_map) normal_maps_.push_back(material.normal_map);
  }
  std::size_t kept = 0;
  DistinctTriangles taken(mesh);
  body.opaque.reserve_more(mesh.triangles.size());
  for (std::uint32_t i = 0; i < mesh.triangles.size(); ++i) {
    const Triangle& triangle = mesh.triangles[i];
    const bool is_cut_out = mesh.materials[triangle.material].opacity != nullptr;
    if (!is_cut_out && !taken.insert(i)) continue;
    PreparedTriangles& target = is_cut_out ? body.cut_out : body.opaque;
    if (body.animation)
      setup.add_animated(triangle, target);
    else if (!setup.add(triangle, target))
      continue;
    target.instances.push_back(numbers.of(triangle));
    ++kept;
  }
  return kept;
}

void SceneBuilder::light(double ambient, const std::vector<LightOptions>& lights,
                         const std::optional<FlickerOptions>& ambient_flicker) {
  is_lit_ = true;
  ambient_ = ambient;
  ambient_flicker_ = ambient_flicker;
  lights_.clear();
  for (const LightOptions& light : lights)
    for (LightOptions& emitter : emitters_of(light)) lights_.push_back(std::move(emitter));
}

Scene SceneBuilder::build(const Background& background) && {
  auto state = std::make_unique<Scene::State>();
  state->background = background;
  state->textures = std::move(textures_);
  PreparedTriangles all = number_triangles();
  SACCADE_CHECK(!all.surfaces.empty());
  if (is_lit_) {
    double extent = 0;
    for (const Body& body : bodies_)
      if (!body.is_empty()) extent = std::max(extent, extent_of(body.box()));
    state->illumination.emplace(ambient_, ambient_flicker_, lights_, kShadowOffset * extent,
                                environment_);
    state->normals = std::move(all.normals);
    set_normal_frames(std::move(all.normal_frames), all.surfaces.size(), *state);
    if (!all.glossy.empty()) state->glosses.resize(all.surfaces.size());
    for (const GlossyTriangle& triangle : all.glossy)
      state->glosses[triangle.number] = triangle.gloss;
  }
  state->surfaces = std::move(all.surfaces);
  state->interiors = std::move(all.interiors);
  state->cutouts = std::move(all.cutouts);
  state->triangle_instances = std::move(all.instances);
  state->instances = std::move(instances_);
  // After the triangles have their numbers, and before they move on with the bodies.
  for (std::size_t i = 1; i < bodies_.size(); ++i) state->animated.push_back(bodies_[i].animated());
  state->visibility.emplace(make_visibility(*state));
  const Body& still = bodies_.front();
  if (!still.is_empty()) state->size_m = extent_of(still.box());
  for (Body& body : bodies_) state->bvh_triangles.push_back(std::move(body).occluders());
  return Scene(std::move(state));
}

void SceneBuilder::set_normal_frames(std::vector<NormalFrame> frames, std::size_t triangles,
                                     Scene::State& state) const {
  if (frames.empty()) return;
  state.normal_frame_of.assign(triangles, kNoFrame);
  for (std::size_t k = 0; k < frames.size(); ++k)
    state.normal_frame_of[frames[k].triangle] = static_cast<std::uint32_t>(k);
  state.normal_frames = std::move(frames);
  state.normal_maps = normal_maps_;
}

PreparedTriangles SceneBuilder::number_triangles() {
  PreparedTriangles all;
  const auto append = [&all](Body& body, PreparedTriangles Body::*part, std::size_t index) {
    PreparedTriangles& triangles = body.*part;
    if (body.is_moving())
      for (TriangleSurface& surface : triangles.surfaces)
        surface.body = static_cast<std::uint32_t>(index - 1);
    const auto first = static_cast<TriangleId>(all.surfaces.size());
    PreparedTriangles moved = std::move(triangles);
    triangles = {};
    triangles.corners = std::move(moved.corners);
    triangles.corner_indices = std::move(moved.corner_indices);
    moved.corners.clear();
    moved.corner_indices.clear();
    all.append(std::move(moved));
    return first;
  };
  for (std::size_t i = 0; i < bodies_.size(); ++i)
    bodies_[i].first_opaque = append(bodies_[i], &Body::opaque, i);
  for (std::size_t i = 0; i < bodies_.size(); ++i)
    bodies_[i].first_cut_out = append(bodies_[i], &Body::cut_out, i);
  return all;
}

Visibility SceneBuilder::make_visibility(const Scene::State& state) const {
  const auto is_opaque = [&state](const Ray& ray, TriangleId triangle) {
    return state.is_opaque(ray, triangle);
  };
  const auto embree_scene_of = [&](const Body& body) {
    if (body.animation)
      return EmbreeScene(body.animation, {body.opaque.corner_indices, body.first_opaque},
                         {body.cut_out.corner_indices, body.first_cut_out}, is_opaque);
    return EmbreeScene({body.opaque.corners, body.first_opaque},
                       {body.cut_out.corners, body.first_cut_out}, is_opaque);
  };
  std::optional<EmbreeScene> static_triangles;
  if (!bodies_.front().is_empty()) static_triangles.emplace(embree_scene_of(bodies_.front()));
  std::vector<MovingObject> objects;
  std::vector<EmbreeScene> embree_scenes;
  for (std::size_t i = 1; i < bodies_.size(); ++i) {
    const Body& body = bodies_[i];
    objects.emplace_back(body.object, body.world_from_body, roomy(body.box()), body.animation);
    embree_scenes.push_back(embree_scene_of(body));
  }
  return {std::move(static_triangles), std::move(objects), std::move(embree_scenes)};
}

}  // namespace saccade
