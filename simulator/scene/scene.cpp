#include "simulator/scene/scene.h"

#include <algorithm>
#include <cmath>
#include <tuple>
#include <utility>

#include "core/check.h"
#include "simulator/scene/scene_state.h"

namespace saccade {
namespace {

/// Rays through a shared edge must meet at least one of its triangles, whatever the rounding.
constexpr double kEdgeTolerance = 1e-10;

/// A shorter vector of a normal map has no direction.
constexpr double kLeastNormal = 1e-6;

/// Triangles this fraction of the scene's size before a plane count as lying in it: what single
/// precision leaves of neighbours in one plane.
constexpr double kCoplanar = 3e-7;

/// As Scene::sample_surface() has it; everything in the surface's frame.
double level_of(const Eigen::Vector3d& normal, const AffineForm& x, const AffineForm& y,
                const Eigen::Vector3d& direction, double distance,
                const RayDifferential& differential) {
  const auto texels = [&](const Eigen::Vector3d& change) {
    const Eigen::Vector3d shift =
        distance * (change - normal.dot(change) / normal.dot(direction) * direction);
    return std::hypot(x.gradient.dot(shift), y.gradient.dot(shift));
  };
  return std::max(0.0, std::log2(std::max(texels(differential.right), texels(differential.down))));
}

/// The unit normals that vectors of a normal map stand for, on the way between two places that have
/// these axes.
VectorRange mapped_normal(const Eigen::Matrix3d& from, const Eigen::Matrix3d& to,
                          const VectorRange& mapped, double length_s) {
  VectorRange vector;
  for (Eigen::Index k = 0; k < 3; ++k)
    vector[static_cast<std::size_t>(k)] =
        dot(range_near_line(Eigen::Vector3d(from.row(k)), Eigen::Vector3d(to.row(k)), length_s),
            mapped);
  return unit(vector);
}

/// What is nearer than `farthest_m` of z depth. Such frusta are narrow and move little, so that a
/// plane before the first one, with some margin, stands for all.
AffineForm nearer_than(double farthest_m, const Frustum& frustum) {
  constexpr double kMargin = 1.2;
  if (!std::isfinite(farthest_m)) return {Eigen::Vector3d::Zero(), 1};
  const Eigen::Vector3d middle = 0.5 * (frustum.corners[0] + frustum.corners[2]);
  const Eigen::Vector3d axis = middle.normalized();
  return {-axis, axis.dot(frustum.eye) + kMargin * farthest_m * axis.dot(middle)};
}

}  // namespace

bool Scene::State::is_opaque(const Ray& ray, TriangleId triangle) const {
  // The ray is in the body's frame already.
  if (animation_of(triangle) != nullptr) {
    const TriangleInstant now = instant(triangle, ray.time_s);
    const CutoutSample seen = sample_cutout(ray, triangle, now.surface, now.interior);
    return !(seen.distance > 0) || seen.opacity >= 0.5;
  }
  const CutoutSample seen = sample_cutout(ray, triangle, surfaces[triangle], interiors[triangle]);
  return !(seen.distance > 0) || seen.opacity >= 0.5;
}

CutoutSample Scene::State::sample_cutout(const Ray& ray, TriangleId triangle,
                                         const TriangleSurface& surface,
                                         const TriangleInterior& interior) const {
  const Cutout& cutout = cutouts[triangle - (surfaces.size() - cutouts.size())];
  const double distance = distance_to(surface.plane, ray);
  if (!(distance > 0 && distance < kFarthest)) return {};
  Eigen::Vector3d point = ray.origin + distance * ray.direction;
  if (animation_of(triangle) != nullptr)
    point = {interior.second.at(point), interior.third.at(point), 0};
  const double x = cutout.x.at(point);
  const double y = cutout.y.at(point);
  return {x, y, distance, cutout.opacity->at_texel(x, y)};
}

LitPoint Scene::State::surface_point(const Ray& ray, const SurfaceSample& seen,
                                     TriangleId triangle) const {
  const TriangleSurface& surface = surfaces[triangle];
  if (surface.body == kStaticBody)
    return local_point(ray, seen, triangle, surface.plane, interiors[triangle], normals[triangle]);
  const CameraFrame frame = visibility->objects()[surface.body].frame(ray.time_s);
  const LitPoint local = with_triangle(
      triangle, ray,
      [&](const Ray& local_ray, const TriangleSurface& now, const TriangleInterior& interior) {
        if (animation_of(triangle) == nullptr)
          return local_point(local_ray, seen, triangle, now.plane, interior, normals[triangle]);
        return local_point(local_ray, seen, triangle, now.plane, interior,
                           normals_at(triangle, ray.time_s, now.plane));
      });
  return {ray.origin + seen.distance * ray.direction,
          frame.rotation * local.plane_normal,
          frame.rotation * local.shading_normal,
          ray.time_s,
          ray.span_s,
          local.has_normal_map};
}

Eigen::Matrix3d Scene::State::normal_map_axes(const Ray& ray, double distance,
                                              TriangleId triangle) const {
  const auto local_axes = [&](const Ray& local) {
    const Eigen::Vector3d point = local.origin + distance * local.direction;
    const double second = interiors[triangle].second.at(point);
    const double third = interiors[triangle].third.at(point);
    const double side = surfaces[triangle].plane.gradient.dot(local.direction) > 0 ? -1.0 : 1.0;
    const ShadingNormals& corners = normals[triangle];
    const Eigen::Vector3d normal = (1 - second - third) * corners[0].cast<double>() +
                                   second * corners[1].cast<double>() +
                                   third * corners[2].cast<double>();
    return Eigen::Matrix3d(side * normal_frame(triangle)->axes(normal.normalized(), second, third));
  };
  const std::uint32_t body = surfaces[triangle].body;
  if (body == kStaticBody) return local_axes(ray);
  const CameraFrame frame = visibility->objects()[body].frame(ray.time_s);
  return frame.rotation * local_axes(in_frame(frame, ray));
}

LitPoint Scene::State::local_point(const Ray& ray, const SurfaceSample& seen, TriangleId triangle,
                                   const AffineForm& plane, const TriangleInterior& interior,
                                   const ShadingNormals& corners) const {
  const Eigen::Vector3d point = ray.origin + seen.distance * ray.direction;
  const double side = plane.gradient.dot(ray.direction) > 0 ? -1.0 : 1.0;
  const double second = interior.second.at(point);
  const double third = interior.third.at(point);
  const Eigen::Vector3d normal = (1 - second - third) * corners[0].cast<double>() +
                                 second * corners[1].cast<double>() +
                                 third * corners[2].cast<double>();
  LitPoint lit{point, side * plane.gradient, side * normal.normalized(), ray.time_s, ray.span_s};
  if (const NormalFrame* frame = normal_frame(triangle)) {
    const Eigen::Vector3d mapped =
        frame->axes(normal.normalized(), second, third) *
        frame->map->at_texel(frame->x.at(point), frame->y.at(point), seen.normal_level);
    if (mapped.norm() > kLeastNormal) lit.shading_normal = side * mapped.normalized();
    lit.has_normal_map = true;
  }
  return lit;
}

SurfaceSample Scene::State::sample_surface(const Ray& ray, const TriangleSurface& surface) const {
  const double distance = distance_to(surface.plane, ray);
  // A ray that grazes the triangle's plane may miss it by far: nothing of it is to be seen there.
  if (!(distance > 0 && distance < kFarthest)) return {};
  const Eigen::Vector3d point = ray.origin + distance * ray.direction;
  return {surface.texture, surface.x.at(point), surface.y.at(point), surface.factor, 1, distance};
}

double Scene::State::min_barycentric(const Ray& ray, const TriangleSurface& surface,
                                     const TriangleInterior& interior) const {
  const double distance = distance_to(surface.plane, ray);
  if (!(distance > 0 && distance < kFarthest)) return -1;
  const Eigen::Vector3d point = ray.origin + distance * ray.direction;
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

TriangleId Scene::visible_exactly(const Ray& ray) const {
  constexpr double kFarther = 1.1;  // less than the margin of nearer_than()
  constexpr double kAround = 1e-5;  // of the direction's length: far above single precision
  constexpr std::size_t kAll = std::numeric_limits<std::size_t>::max();
  const double half = kAround * ray.direction.norm();
  const Eigen::Vector3d right = half * ray.direction.unitOrthogonal();
  const Eigen::Vector3d down = half * ray.direction.cross(right).normalized();
  const Frustum around{ray.origin,
                       {ray.direction - right - down, ray.direction + right - down,
                        ray.direction + right + down, ray.direction - right + down},
                       ray.time_s};
  // What single precision sees is as far as a search needs to go, if it is met at all.
  TriangleId guess = kNothing;
  visible({&ray, 1}, {&guess, 1});
  if (is_animated()) return guess;
  std::vector<TriangleId> triangles;
  const auto nearest_up_to = [&](double farthest) {
    static_cast<void>(collect({&around, 1}, farthest, kAll, triangles));
    return nearest_among(triangles, ray);
  };
  if (guess != kNothing) {
    const double distance = sample_surface(ray, guess).distance;
    const TriangleId nearest = nearest_up_to(distance);
    if (nearest != kNothing && sample_surface(ray, nearest).distance <= distance * kFarther)
      return nearest;
  }
  return nearest_up_to(std::numeric_limits<double>::infinity());
}

TriangleId Scene::nearest_among(std::span<const TriangleId> triangles, const Ray& ray) const {
  TriangleId nearest = kNothing;
  double least = std::numeric_limits<double>::infinity();
  for (const TriangleId triangle : triangles) {
    if (!intersects(ray, triangle)) continue;
    const double distance = sample_surface(ray, triangle).distance;
    if (!(distance < least)) continue;
    nearest = triangle;
    least = distance;
  }
  return nearest;
}

Shade Scene::shade(const Ray& ray, TriangleId triangle) const {
  SurfaceSample seen = sample_surface(ray, triangle);
  state_->illuminate({&ray, 1}, {&triangle, 1}, {&seen, 1}, true);
  return {seen.radiance(), seen.distance};
}

SurfaceSample Scene::sample_surface(const Ray& ray, TriangleId triangle) const {
  if (triangle == kNothing) return state_->background.sample(ray.direction);
  const SurfaceSample seen = state_->with_triangle(
      triangle, ray,
      [&](const Ray& local, const TriangleSurface& surface, const TriangleInterior&) {
        return state_->sample_surface(local, surface);
      });
  return seen.distance > 0 ? seen : state_->background.sample(ray.direction);
}

SurfaceSample Scene::sample_surface(const Ray& ray, TriangleId triangle,
                                    const RayDifferential& differential) const {
  SurfaceSample seen = sample_surface(ray, triangle);
  if (!(seen.distance > 0)) return seen;
  const NormalFrame* const frame = state_->normal_frame(triangle);
  if (seen.texture == nullptr && frame == nullptr) return seen;
  const std::uint32_t body = state_->surfaces[triangle].body;
  RayDifferential turned = differential;
  if (body != kStaticBody) {
    const Eigen::Matrix3d body_from_world =
        moving_objects()[body].frame(ray.time_s).rotation.transpose();
    turned = {body_from_world * differential.right, body_from_world * differential.down};
  }
  std::tie(seen.level, seen.normal_level) = state_->with_triangle(
      triangle, ray,
      [&](const Ray& local, const TriangleSurface& surface, const TriangleInterior&) {
        const auto level = [&](const AffineForm& x, const AffineForm& y) {
          return level_of(surface.plane.gradient, x, y, local.direction, seen.distance, turned);
        };
        return std::pair(seen.texture != nullptr ? level(surface.x, surface.y) : 0.0,
                         frame != nullptr ? level(frame->x, frame->y) : 0.0);
      });
  return seen;
}

Shade Scene::shade(const Ray& ray, TriangleId triangle, const RayDifferential& differential) const {
  SurfaceSample seen = sample_surface(ray, triangle, differential);
  state_->illuminate({&ray, 1}, {&triangle, 1}, {&seen, 1}, true);
  return {seen.radiance(), seen.distance};
}

TexelHomography Scene::texel_homography(TriangleId triangle, const Eigen::Vector3d& position,
                                        const Eigen::Matrix3d& world_from_camera) const {
  SACCADE_CHECK(triangle < state_->surfaces.size() &&
                state_->surfaces[triangle].body == kStaticBody);
  const TriangleSurface& surface = state_->surfaces[triangle];
  const Eigen::Vector3d& normal = surface.plane.gradient;
  const double depth = -surface.plane.at(position);
  const auto row = [&](const AffineForm& form) -> Eigen::Vector3d {
    return world_from_camera.transpose() * (form.at(position) * normal + depth * form.gradient);
  };
  return {row(surface.x), row(surface.y),  world_from_camera.transpose() * normal,
          depth,          surface.texture, surface.factor};
}

void Scene::State::set_light(const Ray& ray, const LitPoint& point, TriangleId triangle,
                             SurfaceSample& seen) const {
  seen.irradiance =
      surfaces[triangle].with_self_light(illumination->irradiance(point, seen.lights));
  if (const Gloss* gloss = gloss_of(triangle))
    seen.mirrored = illumination->mirrored({point, ray.origin}, *gloss, seen.lights);
}

void Scene::State::illuminate(std::span<const Ray> rays, std::span<const TriangleId> triangles,
                              std::span<SurfaceSample> samples, bool within_cones) const {
  SACCADE_CHECK(rays.size() <= kRayPacket && triangles.size() == rays.size() &&
                samples.size() == rays.size());
  if (!illumination) return;
  std::array<LitPoint, kRayPacket> points;
  std::array<LightSet, kRayPacket> lights;
  std::array<std::size_t, kRayPacket> owners;
  std::size_t n = 0;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    if (!(samples[i].distance > 0)) continue;
    points[n] = surface_point(rays[i], samples[i], triangles[i]);
    owners[n++] = i;
  }
  illumination->find_unoccluded_lights({points.data(), n}, *visibility, {lights.data(), n},
                                       within_cones);
  for (std::size_t k = 0; k < n; ++k) {
    SurfaceSample& surface = samples[owners[k]];
    surface.lights = lights[k];
    set_light(rays[owners[k]], points[k], triangles[owners[k]], surface);
  }
}

void Scene::illuminate(std::span<const Ray> rays, std::span<const TriangleId> triangles,
                       std::span<SurfaceSample> samples) const {
  state_->illuminate(rays, triangles, samples, false);
}

void Scene::find_lights(std::span<const Ray> rays, std::span<const TriangleId> triangles,
                        std::span<const SurfaceSample> samples, std::span<const KnownLights> known,
                        std::span<LightSet> lights) const {
  SACCADE_CHECK(rays.size() <= kRayPacket && triangles.size() == rays.size() &&
                samples.size() == rays.size() && known.size() == rays.size() &&
                lights.size() == rays.size() && state_->illumination);
  std::array<LitPoint, kRayPacket> points;
  for (std::size_t i = 0; i < rays.size(); ++i)
    points[i] = state_->surface_point(rays[i], samples[i], triangles[i]);
  state_->illumination->find_unoccluded_lights({points.data(), rays.size()}, *state_->visibility,
                                               lights, false, known);
}

void Scene::set_light(const Ray& ray, TriangleId triangle, SurfaceSample& surface) const {
  if (!state_->illumination || !(surface.distance > 0)) return;
  state_->set_light(ray, state_->surface_point(ray, surface, triangle), triangle, surface);
}

bool Scene::is_glossy(TriangleId triangle) const { return state_->gloss_of(triangle) != nullptr; }

bool Scene::is_lit() const { return state_->illumination.has_value(); }

std::span<const Flicker> Scene::flickers() const {
  return state_->illumination ? state_->illumination->flickers() : std::span<const Flicker>();
}

bool Scene::has_normal_map(TriangleId triangle) const {
  return triangle != kNothing && state_->normal_frame(triangle) != nullptr;
}

bool Scene::has_normal_maps() const { return !state_->normal_frames.empty(); }

NormalTextureSample Scene::sample_normal_map(const Ray& ray, TriangleId triangle,
                                             const SurfaceSample& seen) const {
  SACCADE_CHECK(has_normal_map(triangle));
  const NormalFrame& frame = *state_->normal_frame(triangle);
  return state_->with_triangle(triangle, ray, [&](const Ray& local, const auto&, const auto&) {
    const Eigen::Vector3d point = local.origin + seen.distance * local.direction;
    return NormalTextureSample{frame.map, frame.x.at(point), frame.y.at(point), seen.normal_level};
  });
}

bool Scene::has_spots() const { return state_->illumination && state_->illumination->has_cones(); }

std::optional<SurfaceLightRange> Scene::light_range(const Ray& from_ray, const SurfaceSample& from,
                                                    const Ray& middle_ray, const Ray& to_ray,
                                                    const SurfaceSample& to, TriangleId triangle,
                                                    LightSet lights,
                                                    const VectorRange* mapped) const {
  if (!state_->illumination || triangle == kNothing) return SurfaceLightRange{};
  if (!(from.distance > 0 && to.distance > 0)) return std::nullopt;
  const LitPoint first = state_->surface_point(from_ray, from, triangle);
  const LitPoint last = state_->surface_point(to_ray, to, triangle);
  Eigen::Vector3d middle = first.position;
  if (has_spots()) {
    const double distance = sample_surface(middle_ray, triangle).distance;
    if (!(distance > 0)) return std::nullopt;
    middle = middle_ray.origin + distance * middle_ray.direction;
  }
  std::optional<VectorRange> normal;
  if (mapped != nullptr)
    normal = mapped_normal(state_->normal_map_axes(from_ray, from.distance, triangle),
                           state_->normal_map_axes(to_ray, to.distance, triangle), *mapped,
                           last.time_s - first.time_s);
  const VectorRange* const bounds = normal ? &*normal : nullptr;
  SurfaceLightRange range;
  if (const Gloss* gloss = state_->gloss_of(triangle))
    range.mirrored = state_->illumination->mirrored_range(
        {first, from_ray.origin}, middle, {last, to_ray.origin}, *gloss, lights, bounds);
  const TriangleSurface& surface = state_->surfaces[triangle];
  if (std::isinf(surface.self_light)) return range;
  range.irradiance = state_->illumination->irradiance_range(first, middle, last, lights, bounds);
  range.irradiance.low = surface.with_self_light(range.irradiance.low);
  range.irradiance.high = surface.with_self_light(range.irradiance.high);
  return range;
}

bool Scene::intersects(const Ray& ray, TriangleId triangle) const {
  if (triangle == kNothing) return false;
  return state_->with_triangle(
      triangle, ray,
      [&](const Ray& local, const TriangleSurface& surface, const TriangleInterior& interior) {
        if (!(state_->min_barycentric(local, surface, interior) >= -kEdgeTolerance)) return false;
        if (!is_cut_out(triangle)) return true;
        const CutoutSample seen = state_->sample_cutout(local, triangle, surface, interior);
        return !(seen.distance > 0) || seen.opacity >= 0.5;
      });
}

double Scene::min_barycentric(const Ray& ray, TriangleId triangle) const {
  if (triangle == kNothing) return -1;
  return state_->with_triangle(
      triangle, ray,
      [&](const Ray& local, const TriangleSurface& surface, const TriangleInterior& interior) {
        return state_->min_barycentric(local, surface, interior);
      });
}

bool Scene::is_sole_visible(TriangleId triangle, std::span<const Frustum> frusta) const {
  if (triangle == kNothing)
    return !state_->bvhs.front().may_intersect(frusta, {Eigen::Vector3d::Zero(), 1});
  if (triangle >= state_->surfaces.size() - state_->cutouts.size()) return false;
  const TriangleSurface& surface = state_->surfaces[triangle];
  if (surface.body != kStaticBody) return false;
  for (const Frustum& frustum : frusta)
    for (const Eigen::Vector3d& corner : frustum.corners)
      if (state_->min_barycentric({frustum.eye, corner}, surface, state_->interiors[triangle]) < 0)
        return false;
  // On the eye's side of the plane; what lies in the plane itself, to single precision, is not.
  AffineForm front = surface.plane;
  if (front.at(frusta.front().eye) < 0) front = {-front.gradient, -front.offset};
  front.offset -= kCoplanar * state_->size_m;
  return !state_->bvhs.front().may_intersect(frusta, front);
}

bool Scene::collect(std::span<const Frustum> frusta, double farthest_m, std::size_t most,
                    std::vector<TriangleId>& found) const {
  found.clear();
  if (!state_->bvhs.front().collect(frusta, nearer_than(farthest_m, frusta.front()), most, found))
    return false;
  std::vector<Frustum> local(frusta.size());
  for (std::size_t k = 0; k < moving_objects().size(); ++k) {
    for (std::size_t m = 0; m < frusta.size(); ++m) {
      const CameraFrame frame = moving_objects()[k].frame(frusta[m].time_s);
      local[m].eye = frame.rotation.transpose() * (frusta[m].eye - frame.position);
      for (std::size_t c = 0; c < local[m].corners.size(); ++c)
        local[m].corners[c] = frame.rotation.transpose() * frusta[m].corners[c];
    }
    if (!state_->bvhs[k + 1].collect(local, nearer_than(farthest_m, local.front()), most, found))
      return false;
  }
  return true;
}

EdgeFunctions Scene::edge_functions(TriangleId triangle, const Eigen::Vector3d& position,
                                    const Eigen::Matrix3d& world_from_camera, double time_s) const {
  const std::uint32_t body = state_->surfaces[triangle].body;
  if (body == kStaticBody) return state_->edge_functions(triangle, position, world_from_camera);
  const CameraFrame frame = moving_objects()[body].frame(time_s);
  return state_->edge_functions(triangle, frame.rotation.transpose() * (position - frame.position),
                                frame.rotation.transpose() * world_from_camera);
}

bool Scene::is_cut_out(TriangleId triangle) const {
  return triangle >= state_->surfaces.size() - state_->cutouts.size() && triangle != kNothing;
}

CutoutSample Scene::sample_cutout(const Ray& ray, TriangleId triangle) const {
  SACCADE_CHECK(is_cut_out(triangle));
  return state_->with_triangle(
      triangle, ray,
      [&](const Ray& local, const TriangleSurface& surface, const TriangleInterior& interior) {
        return state_->sample_cutout(local, triangle, surface, interior);
      });
}

EdgeFunctions Scene::State::edge_functions(TriangleId triangle, const Eigen::Vector3d& position,
                                           const Eigen::Matrix3d& body_from_camera) const {
  const AffineForm& plane = surfaces[triangle].plane;
  const TriangleInterior& interior = interiors[triangle];
  const double depth = -plane.at(position);
  const auto row = [&](const AffineForm& form) -> Eigen::Vector3d {
    return body_from_camera.transpose() *
           (form.at(position) * plane.gradient + depth * form.gradient);
  };
  const Eigen::Vector3d second = row(interior.second);
  const Eigen::Vector3d third = row(interior.third);
  const Eigen::Vector3d w = body_from_camera.transpose() * plane.gradient;
  return {{w - second - third, second, third}, w, depth};
}

std::span<const MovingObject> Scene::moving_objects() const {
  return state_->visibility->objects();
}

const MovingObject* Scene::moving_object(TriangleId triangle) const {
  if (triangle == kNothing || state_->surfaces[triangle].body == kStaticBody) return nullptr;
  return &moving_objects()[state_->surfaces[triangle].body];
}

std::uint32_t Scene::object(TriangleId triangle) const {
  SACCADE_CHECK(triangle < state_->surfaces.size());
  return state_->surfaces[triangle].object;
}

std::uint16_t Scene::instance(TriangleId triangle) const {
  return triangle == kNothing ? std::uint16_t{0} : state_->triangle_instances[triangle];
}

std::span<const SceneInstance> Scene::instances() const { return state_->instances; }

std::uint8_t Scene::class_of(std::uint16_t instance) const {
  return instance == 0 ? std::uint8_t{0} : state_->instances[instance - 1U].class_id;
}

Eigen::Vector3d Scene::normal(const Ray& ray, TriangleId triangle) const {
  Eigen::Vector3d normal = state_->with_triangle(
      triangle, ray, [](const Ray&, const TriangleSurface& surface, const TriangleInterior&) {
        return surface.plane.gradient;
      });
  const std::uint32_t body = state_->surfaces[triangle].body;
  if (body != kStaticBody) normal = moving_objects()[body].frame(ray.time_s).rotation * normal;
  return normal.dot(ray.direction) > 0 ? Eigen::Vector3d(-normal) : normal;
}

std::size_t Scene::triangle_count() const { return state_->surfaces.size(); }

}  // namespace saccade
