#include "simulator/scene/scene_builder.h"

#include <fmt/format.h>
#include <malloc.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <future>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "core/check.h"
#include "core/error.h"
#include "core/process/parallel.h"
#include "simulator/scene/light/area_light.h"
#include "simulator/scene/mesh/distinct_triangles.h"
#include "simulator/scene/triangle_setup.h"

namespace saccade {
namespace {

/// Shadow rays start this fraction of the largest body's extent above their surface: ten times what
/// single precision resolves there.
constexpr double kShadowOffset = 1e-6;

Eigen::AlignedBox3f box_of(std::span<const Corners> triangles) {
  Eigen::AlignedBox3f box;
  for (const Corners& corners : triangles)
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
    const std::uint32_t node = label_.splits_nodes ? triangle.node : 0;
    if (last_ != numbers_.end() && last_->first == node) return last_->second;
    bool is_new = false;
    std::tie(last_, is_new) = numbers_.try_emplace(node, std::uint16_t{0});
    if (is_new) last_->second = append(triangle.node);
    return last_->second;
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
  std::map<std::uint32_t, std::uint16_t>::iterator last_ = numbers_.end();
};

/// Some triangles of a mesh, as one thread prepares them.
struct PreparedRange {
  PreparedTriangles opaque, cut_out;
  std::vector<std::uint32_t> kept;  ///< which of the mesh, in their order

  [[nodiscard]] PreparedTriangles& target(bool is_cut_out) { return is_cut_out ? cut_out : opaque; }
};

/// The opaque triangles of a body, or those with cutouts.
struct BodyPart {
  /// In pieces: while a table grows, all that is in it moves again and again.
  std::vector<PreparedTriangles> pieces;
  std::vector<Corners> corners;               ///< of all, once they are numbered
  std::vector<CornerIndices> corner_indices;  ///< likewise, where they move
  TriangleId first = 0;

  [[nodiscard]] bool is_empty() const { return corners.empty() && corner_indices.empty(); }
  [[nodiscard]] std::size_t size() const {
    std::size_t sum = 0;
    for (const PreparedTriangles& piece : pieces) sum += piece.surfaces.size();
    return sum;
  }
  void add(PreparedTriangles&& piece) {
    if (!piece.surfaces.empty()) pieces.push_back(std::move(piece));
  }
};

}  // namespace

struct SceneBuilder::Body {
  std::optional<Spline> world_from_body;  ///< none: is static
  std::uint32_t object = 0;               ///< of a moving one
  std::shared_ptr<const VertexAnimation> animation;
  BodyPart opaque, cut_out;

  [[nodiscard]] bool is_moving() const { return world_from_body || animation; }
  [[nodiscard]] bool is_empty() const { return opaque.is_empty() && cut_out.is_empty(); }
  [[nodiscard]] Eigen::AlignedBox3f box() const {
    return animation ? animation->box() : box_of(opaque.corners).merged(box_of(cut_out.corners));
  }
  [[nodiscard]] AnimatedTriangles animated() const {
    return {opaque.corner_indices, cut_out.corner_indices, opaque.first, cut_out.first};
  }
  [[nodiscard]] TriangleBvh bvh() const {
    return TriangleBvh({{opaque.corners, opaque.first}, {cut_out.corners, cut_out.first}});
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
  const auto is_cut_out = [&mesh](std::uint32_t i) {
    return mesh.materials[mesh.triangles[i].material].opacity != nullptr;
  };
  std::vector<std::uint32_t> distinct;
  distinct.reserve(mesh.triangles.size());
  DistinctTriangles taken(mesh);
  for (std::uint32_t i = 0; i < mesh.triangles.size(); ++i)
    if (is_cut_out(i) || taken.insert(i)) distinct.push_back(i);

  // Small enough that the threads end together, and that memory is given back in between.
  constexpr std::size_t kRange = 1U << 14U;
  std::vector<PreparedRange> ranges((distinct.size() + kRange - 1) / kRange);
  parallel_for_ranges(distinct.size(), kRange, [&](std::size_t begin, std::size_t end) {
    PreparedRange& range = ranges[begin / kRange];
    range.kept.reserve(end - begin);
    range.opaque.reserve(static_cast<std::size_t>(std::count_if(
        &distinct[begin], &distinct[begin] + (end - begin), std::not_fn(is_cut_out))));
    for (std::size_t k = begin; k < end; ++k) {
      const Triangle& triangle = mesh.triangles[distinct[k]];
      PreparedTriangles& target = range.target(is_cut_out(distinct[k]));
      if (body.animation)
        setup.add_animated(triangle, target);
      else if (!setup.add(triangle, target))
        continue;
      range.kept.push_back(distinct[k]);
    }
  });
  std::size_t kept = 0;
  for (PreparedRange& range : ranges) {
    for (const std::uint32_t i : range.kept)
      range.target(is_cut_out(i)).instances.push_back(numbers.of(mesh.triangles[i]));
    kept += range.kept.size();
    body.opaque.add(std::move(range.opaque));
    body.cut_out.add(std::move(range.cut_out));
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
  // From here on the triangles have their numbers. Embree's trees and ours take as long.
  auto bvhs = std::async(thread_count() > 1 ? std::launch::async : std::launch::deferred, [this] {
    std::vector<TriangleBvh> of_bodies;
    for (const Body& body : bodies_) of_bodies.push_back(body.bvh());
    return of_bodies;
  });
  for (std::size_t i = 1; i < bodies_.size(); ++i) state->animated.push_back(bodies_[i].animated());
  state->visibility.emplace(make_visibility(*state));
  const Body& still = bodies_.front();
  if (!still.is_empty()) state->size_m = extent_of(still.box());
  state->bvhs = bvhs.get();
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
  std::size_t count = 0;
  for (const Body& body : bodies_) count += body.opaque.size() + body.cut_out.size();
  const auto append = [&](std::size_t index, BodyPart Body::*part) {
    BodyPart& to = bodies_[index].*part;
    to.first = static_cast<TriangleId>(all.surfaces.size());
    to.corners.reserve(bodies_[index].animation ? 0 : to.size());
    for (PreparedTriangles& piece : to.pieces) {
      // A scene of one piece moves as it is.
      if (piece.surfaces.size() < count) all.reserve(count);
      if (bodies_[index].is_moving())
        for (TriangleSurface& surface : piece.surfaces)
          surface.body = static_cast<std::uint32_t>(index - 1);
      saccade::append(to.corners, std::exchange(piece.corners, {}));
      saccade::append(to.corner_indices, std::exchange(piece.corner_indices, {}));
      all.append(std::exchange(piece, {}));
    }
    to.pieces.clear();
  };
  for (std::size_t i = 0; i < bodies_.size(); ++i) append(i, &Body::opaque);
  for (std::size_t i = 0; i < bodies_.size(); ++i) append(i, &Body::cut_out);
  // What the pieces leave behind is as much as the tables, and what follows has no use for it.
  malloc_trim(0);
  return all;
}

Visibility SceneBuilder::make_visibility(const Scene::State& state) const {
  const auto is_opaque = [&state](const Ray& ray, TriangleId triangle) {
    return state.is_opaque(ray, triangle);
  };
  const auto embree_scene_of = [&](const Body& body) {
    if (body.animation)
      return EmbreeScene(body.animation, {body.opaque.corner_indices, body.opaque.first},
                         {body.cut_out.corner_indices, body.cut_out.first}, is_opaque);
    return EmbreeScene({body.opaque.corners, body.opaque.first},
                       {body.cut_out.corners, body.cut_out.first}, is_opaque);
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
