#include "simulator/scene/scene.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "core/check.h"
#include "simulator/scene/scene_state.h"

namespace saccade {
namespace {

/// Beyond this many lengths of its direction a ray has left the triangle by more than a hair.
constexpr double kFarthest = 1e12;
/// Rays through a shared edge must meet at least one of its triangles, whatever the rounding.
constexpr double kEdgeTolerance = 1e-10;

/// Triangles this share of the scene's size before a plane count as lying in it: what single
/// precision leaves of neighbours in one plane.
constexpr double kSamePlane = 3e-7;

/// As Scene::look() has it; everything in the surface's frame.
double level_of(const TriangleSurface& surface, const Eigen::Vector3d& direction, double distance,
                const RaySpread& spread) {
  const Eigen::Vector3d& normal = surface.plane.gradient;
  const auto texels = [&](const Eigen::Vector3d& change) {
    const Eigen::Vector3d shift =
        distance * (change - normal.dot(change) / normal.dot(direction) * direction);
    return std::hypot(surface.x.gradient.dot(shift), surface.y.gradient.dot(shift));
  };
  return std::max(0.0, std::log2(std::max(texels(spread.right), texels(spread.down))));
}

}  // namespace

bool Scene::State::is_opaque(const Ray& ray, TriangleId triangle) const {
  const Cutout& cutout = cutouts[triangle - (surfaces.size() - cutouts.size())];
  const double distance = distance_to(surfaces[triangle].plane, ray);
  if (!(distance > 0 && distance < kFarthest)) return true;
  const Eigen::Vector3d point = ray.origin + distance * ray.direction;
  return cutout.opacity->at_texel(cutout.x.at(point), cutout.y.at(point)) >= 0.5;
}

SurfacePoint Scene::State::surface_point(const Ray& ray, double distance,
                                         TriangleId triangle) const {
  const TriangleSurface& surface = surfaces[triangle];
  if (surface.body == kStill) return local_point(ray, distance, triangle);
  const CameraFrame frame = visibility->objects()[surface.body].frame(ray.time_s);
  const SurfacePoint local = local_point(in_frame(frame, ray), distance, triangle);
  return {ray.origin + distance * ray.direction, frame.rotation * local.plane_normal,
          frame.rotation * local.shading_normal, ray.time_s};
}

SurfacePoint Scene::State::local_point(const Ray& ray, double distance, TriangleId triangle) const {
  const AffineForm& plane = surfaces[triangle].plane;
  const Eigen::Vector3d point = ray.origin + distance * ray.direction;
  const double side = plane.gradient.dot(ray.direction) > 0 ? -1.0 : 1.0;
  const double second = interiors[triangle].second.at(point);
  const double third = interiors[triangle].third.at(point);
  const ShadingNormals& corners = normals[triangle];
  const Eigen::Vector3d normal = (1 - second - third) * corners[0].cast<double>() +
                                 second * corners[1].cast<double>() +
                                 third * corners[2].cast<double>();
  return {point, side * plane.gradient, side * normal.normalized(), ray.time_s};
}

SurfaceLook Scene::State::look(const Ray& ray, const TriangleSurface& surface) const {
  const double distance = distance_to(surface.plane, ray);
  // A ray that grazes the triangle's plane may miss it by far: nothing of it is to be seen there.
  if (!(distance > 0 && distance < kFarthest)) return {};
  const Eigen::Vector3d point = ray.origin + distance * ray.direction;
  return {surface.texture, surface.x.at(point), surface.y.at(point), surface.factor, 1, distance};
}

double Scene::State::inside(const Ray& ray, TriangleId triangle) const {
  const double distance = distance_to(surfaces[triangle].plane, ray);
  if (!(distance > 0 && distance < kFarthest)) return -1;
  const Eigen::Vector3d point = ray.origin + distance * ray.direction;
  const TriangleInterior& interior = interiors[triangle];
  const double second = interior.second.at(point);
  const double third = interior.third.at(point);
  return std::min({second, third, 1 - second - third});
}

Scene::Scene(std::unique_ptr<State> state) : state_(std::move(state)) {}
Scene::~Scene() = default;
Scene::Scene(Scene&&) noexcept = default;
Scene& Scene::operator=(Scene&&) noexcept = default;

void Scene::visible(std::span<const Ray> rays, std::span<TriangleId> triangles) const {
  state_->visibility->nearest(rays, triangles);
}

Shade Scene::shade(const Ray& ray, TriangleId triangle) const {
  SurfaceLook seen = look(ray, triangle);
  illuminate({&ray, 1}, {&triangle, 1}, {&seen, 1});
  return {seen.radiance(), seen.distance};
}

SurfaceLook Scene::look(const Ray& ray, TriangleId triangle) const {
  if (triangle == kNothing) return state_->background.look(ray.direction);
  const TriangleSurface& surface = state_->surfaces[triangle];
  const SurfaceLook seen = state_->in_frame_of(
      surface.body, ray, [&](const Ray& local) { return state_->look(local, surface); });
  return seen.distance > 0 ? seen : state_->background.look(ray.direction);
}

SurfaceLook Scene::look(const Ray& ray, TriangleId triangle, const RaySpread& spread) const {
  SurfaceLook seen = look(ray, triangle);
  if (seen.texture == nullptr || !(seen.distance > 0)) return seen;
  const TriangleSurface& surface = state_->surfaces[triangle];
  if (surface.body == kStill) {
    seen.level = level_of(surface, ray.direction, seen.distance, spread);
  } else {
    const Eigen::Matrix3d body_from_world =
        state_->visibility->objects()[surface.body].frame(ray.time_s).rotation.transpose();
    seen.level = level_of(surface, body_from_world * ray.direction, seen.distance,
                          {body_from_world * spread.right, body_from_world * spread.down});
  }
  return seen;
}

Shade Scene::shade(const Ray& ray, TriangleId triangle, const RaySpread& spread) const {
  SurfaceLook seen = look(ray, triangle, spread);
  illuminate({&ray, 1}, {&triangle, 1}, {&seen, 1});
  return {seen.radiance(), seen.distance};
}

TexelMap Scene::texel_map(TriangleId triangle, const Eigen::Vector3d& position,
                          const Eigen::Matrix3d& world_from_camera) const {
  SACCADE_CHECK(triangle < state_->surfaces.size() && state_->surfaces[triangle].body == kStill);
  const TriangleSurface& surface = state_->surfaces[triangle];
  const Eigen::Vector3d& normal = surface.plane.gradient;
  const double depth = -surface.plane.at(position);
  const auto row = [&](const AffineForm& form) -> Eigen::Vector3d {
    return world_from_camera.transpose() * (form.at(position) * normal + depth * form.gradient);
  };
  return {row(surface.x), row(surface.y),  world_from_camera.transpose() * normal,
          depth,          surface.texture, surface.factor};
}

void Scene::illuminate(std::span<const Ray> rays, std::span<const TriangleId> triangles,
                       std::span<SurfaceLook> looks) const {
  SACCADE_CHECK(rays.size() <= kPacket && triangles.size() == rays.size() &&
                looks.size() == rays.size());
  if (!state_->illumination) return;
  std::array<SurfacePoint, kPacket> points;
  std::array<LampSet, kPacket> lamps;
  std::array<std::size_t, kPacket> owners;
  std::size_t n = 0;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    if (!(looks[i].distance > 0)) continue;
    points[n] = state_->surface_point(rays[i], looks[i].distance, triangles[i]);
    owners[n++] = i;
  }
  state_->illumination->find_lamps({points.data(), n}, *state_->visibility, {lamps.data(), n});
  for (std::size_t k = 0; k < n; ++k) {
    SurfaceLook& look = looks[owners[k]];
    look.lamps = lamps[k];
    look.irradiance = state_->illumination->from_lamps(points[k], lamps[k]);
  }
}

double Scene::irradiance(const Ray& ray, TriangleId triangle, const SurfaceLook& look) const {
  if (!state_->illumination || !(look.distance > 0)) return 1;
  return state_->illumination->from_lamps(state_->surface_point(ray, look.distance, triangle),
                                          look.lamps);
}

bool Scene::is_lit() const { return state_->illumination.has_value(); }

bool Scene::meets(const Ray& ray, TriangleId triangle) const {
  if (triangle == kNothing) return false;
  const std::size_t opaque = state_->surfaces.size() - state_->cutouts.size();
  return state_->in_frame_of(state_->surfaces[triangle].body, ray, [&](const Ray& local) {
    return state_->inside(local, triangle) >= -kEdgeTolerance &&
           (triangle < opaque || state_->is_opaque(local, triangle));
  });
}

double Scene::inside(const Ray& ray, TriangleId triangle) const {
  if (triangle == kNothing) return -1;
  return state_->in_frame_of(state_->surfaces[triangle].body, ray,
                             [&](const Ray& local) { return state_->inside(local, triangle); });
}

const OccluderTree& Scene::State::occluders() {
  std::call_once(tree_built, [this] {
    tree.emplace(still_corners, still_ids);
    still_corners = {};
    still_ids = {};
  });
  return *tree;
}

bool Scene::is_alone(TriangleId triangle, std::span<const SightPyramid> sweep) const {
  if (triangle == kNothing)
    return !state_->occluders().may_show(sweep, {Eigen::Vector3d::Zero(), 1});
  if (triangle >= state_->surfaces.size() - state_->cutouts.size()) return false;
  const TriangleSurface& surface = state_->surfaces[triangle];
  if (surface.body != kStill) return false;
  for (const SightPyramid& pyramid : sweep)
    for (const Eigen::Vector3d& corner : pyramid.corners)
      if (state_->inside({pyramid.eye, corner}, triangle) < 0) return false;
  // On the eye's side of the plane; what lies in the plane itself, to single precision, is not.
  AffineForm front = surface.plane;
  if (front.at(sweep.front().eye) < 0) front = {-front.gradient, -front.offset};
  front.offset -= kSamePlane * state_->size_m;
  return !state_->occluders().may_show(sweep, front);
}

bool Scene::collect(std::span<const SightPyramid> sweep, double farthest_m, std::size_t most,
                    std::vector<TriangleId>& found) const {
  const SightPyramid& pyramid = sweep.front();
  const Eigen::Vector3d axis = (pyramid.corners[0] + pyramid.corners[2]).normalized();
  // The pyramids are narrow and move little, so that a plane before the first one stands for all.
  constexpr double kRoom = 1.2;
  const AffineForm front =
      std::isfinite(farthest_m)
          ? AffineForm{-axis, axis.dot(pyramid.eye) +
                                  kRoom * farthest_m *
                                      axis.dot(0.5 * (pyramid.corners[0] + pyramid.corners[2]))}
          : AffineForm{Eigen::Vector3d::Zero(), 1};
  return state_->occluders().collect(sweep, front, most, found);
}

TrianglePass Scene::triangle_pass(TriangleId triangle, const Eigen::Vector3d& position,
                                  const Eigen::Matrix3d& world_from_camera) const {
  const AffineForm& plane = state_->surfaces[triangle].plane;
  const TriangleInterior& interior = state_->interiors[triangle];
  const double depth = -plane.at(position);
  const double side = depth < 0 ? -1 : 1;
  const auto row = [&](const AffineForm& form) -> Eigen::Vector3d {
    return side * (world_from_camera.transpose() *
                   (form.at(position) * plane.gradient + depth * form.gradient));
  };
  const Eigen::Vector3d second = row(interior.second);
  const Eigen::Vector3d third = row(interior.third);
  const Eigen::Vector3d w = side * (world_from_camera.transpose() * plane.gradient);
  return {{w - second - third, second, third}, w, side * depth};
}

bool Scene::is_cut_out(TriangleId triangle) const {
  return triangle >= state_->surfaces.size() - state_->cutouts.size() && triangle != kNothing;
}

std::span<const MovingObject> Scene::moving_objects() const {
  return state_->visibility->objects();
}

const MovingObject* Scene::moving_object(TriangleId triangle) const {
  if (triangle == kNothing || state_->surfaces[triangle].body == kStill) return nullptr;
  return &moving_objects()[state_->surfaces[triangle].body];
}

std::uint32_t Scene::object(TriangleId triangle) const {
  SACCADE_CHECK(triangle < state_->surfaces.size());
  return state_->surfaces[triangle].object;
}

std::size_t Scene::triangle_count() const { return state_->surfaces.size(); }

}  // namespace saccade
