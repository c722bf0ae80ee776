#include "simulator/scene/scene.h"

#include <utility>

#include "core/check.h"
#include "simulator/scene/scene_state.h"

namespace saccade {
namespace {

/// Beyond this many lengths of its direction a ray has left the triangle by more than a hair.
constexpr double kFarthest = 1e12;
/// Rays through a shared edge must meet at least one of its triangles, whatever the rounding.
constexpr double kEdgeTolerance = 1e-10;

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
  const Eigen::Vector3d point = ray.origin + distance * ray.direction;
  const double side = surface.plane.gradient.dot(ray.direction) > 0 ? -1.0 : 1.0;
  const double second = interiors[triangle].second.at(point);
  const double third = interiors[triangle].third.at(point);
  const ShadingNormals& corners = normals[triangle];
  const Eigen::Vector3d normal = (1 - second - third) * corners[0].cast<double>() +
                                 second * corners[1].cast<double>() +
                                 third * corners[2].cast<double>();
  return {point, side * surface.plane.gradient, side * normal.normalized()};
}

Scene::Scene(std::unique_ptr<State> state) : state_(std::move(state)) {}
Scene::~Scene() = default;
Scene::Scene(Scene&&) noexcept = default;
Scene& Scene::operator=(Scene&&) noexcept = default;

void Scene::visible(std::span<const Ray> rays, std::span<TriangleId> triangles) const {
  state_->caster->nearest(rays, triangles);
}

Shade Scene::shade(const Ray& ray, TriangleId triangle) const {
  if (triangle == kNothing) return {state_->background.radiance(ray.direction), 0};
  const TriangleSurface& surface = state_->surfaces[triangle];
  const double distance = distance_to(surface.plane, ray);
  // A ray that grazes the triangle's plane may miss it by far: nothing of it is to be seen there.
  if (!(distance > 0 && distance < kFarthest))
    return {state_->background.radiance(ray.direction), 0};
  const Eigen::Vector3d point = ray.origin + distance * ray.direction;
  const double x = surface.x.at(point);
  double radiance = surface.texture != nullptr
                        ? surface.factor * surface.texture->at_texel(x, surface.y.at(point))
                        : x;
  if (state_->illumination)
    radiance *=
        state_->illumination->at(state_->surface_point(ray, distance, triangle), *state_->caster);
  return {radiance, distance};
}

bool Scene::meets(const Ray& ray, TriangleId triangle) const {
  if (triangle == kNothing) return false;
  const double distance = distance_to(state_->surfaces[triangle].plane, ray);
  if (!(distance > 0 && distance < kFarthest)) return false;
  const Eigen::Vector3d point = ray.origin + distance * ray.direction;
  const TriangleInterior& interior = state_->interiors[triangle];
  const double second = interior.second.at(point);
  const double third = interior.third.at(point);
  if (second < -kEdgeTolerance || third < -kEdgeTolerance || second + third > 1 + kEdgeTolerance)
    return false;
  const std::size_t opaque = state_->surfaces.size() - state_->cutouts.size();
  return triangle < opaque || state_->is_opaque(ray, triangle);
}

std::uint32_t Scene::object(TriangleId triangle) const {
  SACCADE_CHECK(triangle < state_->surfaces.size());
  return state_->surfaces[triangle].object;
}

std::size_t Scene::triangle_count() const { return state_->surfaces.size(); }

}  // namespace saccade
