#include "simulator/sensor/rays/ray_tracer.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>

#include "core/check.h"
#include "simulator/sensor/rays/tile_trace.h"

namespace saccade {
namespace {

/// How far outside its edges a ray still counts as meeting a triangle at its border [barycentric].
constexpr double kAtEdge = 1e-3;
/// Rates are differences over this time: short against any motion, long against rounding.
constexpr double kSoon_s = 1e-7;

/// Where more triangles than this may hide a lamp from a patch, shadow rays are quicker.
constexpr std::size_t kMostCasters = 8192;
/// Of patches whose light is found in one go.
constexpr std::size_t kMostLights = 256;

RayView with_rates(const SurfaceLook& now, const SurfaceLook& soon, double soon_s,
                   TriangleId triangle) {
  RayView view{triangle, now, 0, 0};
  if (soon.texture != now.texture || (soon.distance == 0) != (now.distance == 0)) return view;
  view.x_rate = (soon.x - now.x) / soon_s;
  view.y_rate = (soon.y - now.y) / soon_s;
  view.level_rate = (soon.level - now.level) / soon_s;
  return view;
}

}  // namespace

void EventStatistics::add(const EventStatistics& other) {
  rays += other.rays;
  lit_points += other.lit_points;
  surface_looks += other.surface_looks;
  lost += other.lost;
  time_bound_s = std::max(time_bound_s, other.time_bound_s);
}

Ray RayTracer::ray_at(const Eigen::Vector3d& direction, double t_s) const {
  const CameraFrame camera = poses_->at(t_s);
  return {camera.position, camera.rotation * direction, t_s};
}

SurfaceLook RayTracer::surface_look(const Eigen::Vector3d& direction, TriangleId triangle,
                                    const CameraFrame& camera, double t_s) const {
  const Ray ray{camera.position, camera.rotation * direction, t_s};
  if (footprints_ == nullptr) return scene_.look(ray, triangle);
  return scene_.look(ray, triangle, spread_in_world(*footprints_, camera.rotation, direction));
}

RayView RayTracer::view(const Eigen::Vector3d& direction, TriangleId triangle, double t_s) {
  RayView view = unlit_view(direction, triangle, t_s);
  if (scene_.is_lit()) {
    const Ray ray = ray_at(direction, t_s);
    illuminate({&ray, 1}, {&view, 1});
  }
  return view;
}

RayView RayTracer::view(const Eigen::Vector3d& direction, TriangleId triangle, LampSet lamps,
                        double t_s) {
  RayView view = unlit_view(direction, triangle, t_s);
  if (!scene_.is_lit()) return view;
  view.look.lamps = lamps;
  view.look.irradiance = scene_.irradiance(ray_at(direction, t_s), triangle, view.look);
  return view;
}

double RayTracer::difference_s(double t_s) const {
  return t_s + kSoon_s <= poses_->to_s() ? kSoon_s : -kSoon_s;
}

RayView RayTracer::unlit_view(const Eigen::Vector3d& direction, TriangleId triangle, double t_s) {
  ++statistics_.surface_looks;
  const double soon_s = difference_s(t_s);
  return with_rates(surface_look(direction, triangle, poses_->at(t_s), t_s),
                    surface_look(direction, triangle, poses_->at(t_s + soon_s), t_s + soon_s),
                    soon_s, triangle);
}

void RayTracer::use(const std::array<Eigen::Vector3d, 4>& outline, double from_s, double to_s) {
  finds_lights_ = is_lit();
  light_count_ = 0;
  if (finds_lights_) sweep_ = sweep_of(outline, from_s, to_s);
}

const PatchLight* RayTracer::light_of(TriangleId triangle) {
  if (!finds_lights_ || triangle == kNothing) return nullptr;
  for (std::size_t k = light_count_; k-- > 0;)
    if (lights_[k].triangle == triangle) return lights_[k].light();
  if (light_count_ == kMostLights) return nullptr;
  if (light_count_ == lights_.size()) lights_.emplace_back();
  KnownLight& known = lights_[light_count_++];
  known.triangle = triangle;
  const PatchLight* light = scene_.find_light(triangle, sweep_, kMostCasters, known.patch);
  known.is_known = light == &known.patch;
  known.whole = known.is_known ? nullptr : light;
  return light;
}

Eigen::Vector3d RayTracer::point_at(const Eigen::Vector3d& direction, TriangleId triangle,
                                    double t_s) const {
  const Ray ray = ray_at(direction, t_s);
  const double distance = scene_.look(ray, triangle).distance;
  if (!(distance > 0)) return Eigen::Vector3d::Constant(std::numeric_limits<double>::quiet_NaN());
  return ray.origin + distance * ray.direction;
}

void RayTracer::illuminate(std::span<const Ray> rays, std::span<RayView> views) {
  std::array<Ray, kPacket> doubtful;
  std::array<TriangleId, kPacket> triangles;
  std::array<SurfaceLook, kPacket> looks;
  std::array<std::size_t, kPacket> owners;
  std::size_t n = 0;
  for (std::size_t k = 0; k < rays.size(); ++k) {
    SurfaceLook& look = views[k].look;
    if (const PatchLight* light = light_of(views[k].triangle); light && look.distance > 0) {
      look.lamps = light->lamps_at(rays[k].origin + look.distance * rays[k].direction);
      look.irradiance = scene_.irradiance(rays[k], views[k].triangle, look);
      continue;
    }
    doubtful[n] = rays[k];
    triangles[n] = views[k].triangle;
    looks[n] = look;
    owners[n++] = k;
  }
  if (n == 0) return;
  scene_.illuminate({doubtful.data(), n}, {triangles.data(), n}, {looks.data(), n});
  for (std::size_t k = 0; k < n; ++k) views[owners[k]].look = looks[k];
  statistics_.lit_points += n;
}

void RayTracer::find_triangles(std::span<const Eigen::Vector3d> directions, double t_s,
                               std::span<TriangleId> triangles) {
  SACCADE_CHECK(directions.size() <= kPacket && triangles.size() == directions.size());
  const CameraFrame camera = poses_->at(t_s);
  std::array<Ray, kPacket> rays;
  for (std::size_t k = 0; k < directions.size(); ++k)
    rays[k] = {camera.position, camera.rotation * directions[k], t_s};
  scene_.visible({rays.data(), directions.size()}, triangles);
  statistics_.rays += directions.size();
}

void RayTracer::trace(std::span<const Eigen::Vector3d> directions, double t_s,
                      std::span<RayView> views) {
  std::array<TriangleId, kPacket> triangles;
  const std::span<TriangleId> seen(triangles.data(), directions.size());
  for (std::size_t k = 0; k < directions.size(); ++k) {
    const Ray ray = ray_at(directions[k], t_s);
    seen[k] = scene_.nearest_of(within_reach_, ray);
    if (seen[k] != kNothing) continue;
    seen[k] = scene_.visible_exactly(ray);
    ++statistics_.rays;
  }
  see(directions, seen, t_s, views);
}

void RayTracer::see(std::span<const Eigen::Vector3d> directions,
                    std::span<const TriangleId> triangles, double t_s, std::span<RayView> views) {
  SACCADE_CHECK(triangles.size() == directions.size() && views.size() == directions.size());
  const CameraFrame camera = poses_->at(t_s);
  const double soon_s = difference_s(t_s);
  const CameraFrame soon = poses_->at(t_s + soon_s);
  std::optional<PlaneView> plane;
  for (std::size_t k = 0; k < directions.size(); ++k) {
    const TriangleId triangle = triangles[k];
    if (footprints_ != nullptr || triangle == kNothing ||
        scene_.moving_object(triangle) != nullptr) {
      views[k] =
          with_rates(surface_look(directions[k], triangle, camera, t_s),
                     surface_look(directions[k], triangle, soon, t_s + soon_s), soon_s, triangle);
      continue;
    }
    if (!plane || plane->triangle() != triangle)
      plane.emplace(scene_.texel_map(triangle, camera.position, camera.rotation),
                    scene_.texel_map(triangle, soon.position, soon.rotation), soon_s, triangle);
    views[k] = plane->at(directions[k]);
  }
  if (!scene_.is_lit()) return;
  std::array<Ray, kPacket> rays;
  for (std::size_t first = 0; first < directions.size(); first += kPacket) {
    const std::size_t n = std::min(kPacket, directions.size() - first);
    for (std::size_t k = 0; k < n; ++k)
      rays[k] = {camera.position, camera.rotation * directions[first + k], t_s};
    illuminate({rays.data(), n}, views.subspan(first, n));
  }
}

InverseDepthRange RayTracer::inverse_depths(std::span<const Eigen::Vector3d> directions,
                                            std::span<const TriangleId> triangles,
                                            double t_s) const {
  const CameraFrame camera = poses_->at(t_s);
  InverseDepthRange range{std::numeric_limits<double>::infinity(), 0};
  TrianglePass plane;
  for (std::size_t k = 0; k < directions.size(); ++k) {
    double inverse = 0;
    if (triangles[k] != kNothing) {
      if (k == 0 || triangles[k] != triangles[k - 1])
        plane = scene_.triangle_pass(triangles[k], camera.position, camera.rotation, t_s);
      inverse = std::max(plane.w.dot(directions[k]) / plane.depth, 0.0);
    }
    range.low = std::min(range.low, inverse);
    range.high = std::max(range.high, inverse);
  }
  return range;
}

PlaneView RayTracer::plane_view(TriangleId triangle, double t_s) const {
  const CameraFrame camera = poses_->at(t_s);
  const double soon_s = difference_s(t_s);
  const CameraFrame soon = poses_->at(t_s + soon_s);
  return {scene_.texel_map(triangle, camera.position, camera.rotation),
          scene_.texel_map(triangle, soon.position, soon.rotation), soon_s, triangle};
}

bool RayTracer::is_alone(TriangleId triangle, const std::array<Eigen::Vector3d, 4>& outline,
                         double from_s, double to_s) const {
  const auto sweep = sweep_of(outline, from_s, to_s);
  return scene_.is_alone(triangle, sweep);
}

bool RayTracer::collect(const std::array<Eigen::Vector3d, 4>& outline, double farthest_m,
                        double from_s, double to_s, std::size_t most,
                        std::vector<TriangleId>& found) const {
  const auto sweep = sweep_of(outline, from_s, to_s);
  return scene_.collect(sweep, farthest_m, most, found);
}

auto RayTracer::sweep_of(const std::array<Eigen::Vector3d, 4>& outline, double from_s,
                         double to_s) const -> Sweep {
  Sweep sweep;
  const double step_s = (to_s - from_s) / static_cast<double>(sweep.size() - 1);
  for (std::size_t m = 0; m + 1 < sweep.size(); ++m)
    sweep[m] = pyramid_at(outline, from_s + static_cast<double>(m) * step_s);
  sweep.back() = pyramid_at(outline, to_s);
  return sweep;
}

SightPyramid RayTracer::pyramid_at(const std::array<Eigen::Vector3d, 4>& outline,
                                   double t_s) const {
  const CameraFrame camera = poses_->at(t_s);
  SightPyramid pyramid{camera.position, {}, t_s};
  for (std::size_t k = 0; k < outline.size(); ++k)
    pyramid.corners[k] = camera.rotation * outline[k];
  return pyramid;
}

std::vector<OpaqueStretch> RayTracer::find_holes(const Eigen::Vector3d& direction,
                                                 TriangleId triangle, double from_s,
                                                 double to_s) const {
  constexpr double kLooksPerTexel = 4;
  constexpr double kMostLooks = 64;
  const auto look = [&](double t_s) {
    return scene_.cutout_look(ray_at(direction, t_s), triangle);
  };
  const CutoutLook first = look(from_s);
  const CutoutLook last = look(to_s);
  const double texels = std::max(std::abs(last.x - first.x), std::abs(last.y - first.y));
  const double steps = std::clamp(std::ceil(kLooksPerTexel * texels), 4.0, kMostLooks);
  const auto opacity = [&](double t_s) { return look(t_s).opacity; };
  return OpacitySearch(opacity, {from_s, first.opacity}, {to_s, last.opacity},
                       static_cast<std::size_t>(steps))
      .stretches();
}

bool RayTracer::sees(const Eigen::Vector3d& direction, TriangleId triangle,
                     std::span<const TriangleId> among, double t_s) const {
  return scene_.nearest_of(among, ray_at(direction, t_s)) == triangle;
}

double RayTracer::inside(const Eigen::Vector3d& direction, TriangleId triangle, double t_s) const {
  return scene_.inside(ray_at(direction, t_s), triangle);
}

double RayTracer::change_s(const Eigen::Vector3d& direction, const Sighting& from,
                           const Sighting& to, double tolerance_s) const {
  TriangleId triangle = from.triangle;
  double a_s = from.t_s, b_s = to.t_s;
  double a = inside(direction, triangle, a_s);
  double b = inside(direction, triangle, b_s);
  if (!(b < 0)) {
    triangle = to.triangle;
    a = inside(direction, triangle, a_s);
    b = inside(direction, triangle, b_s);
  }
  if ((a < 0) == (b < 0)) return std::numeric_limits<double>::quiet_NaN();
  // False position, Illinois variant, on the smallest barycentric coordinate.
  constexpr int kMostSteps = 20;
  double t = a_s;
  for (int k = 0, last = 0; k < kMostSteps && b_s - a_s > tolerance_s; ++k) {
    const double before = t;
    t = a_s + (b_s - a_s) * std::clamp(a / (a - b), 0.001, 0.999);
    const double value = inside(direction, triangle, t);
    const bool is_first = (value < 0) == (a < 0);
    (is_first ? a_s : b_s) = t;
    (is_first ? a : b) = value;
    if (last == (is_first ? 1 : -1)) (is_first ? b : a) *= 0.5;
    last = is_first ? 1 : -1;
    if (std::abs(t - before) < tolerance_s) break;
  }
  return a_s + (b_s - a_s) * std::clamp(a / (a - b), 0.0, 1.0);
}

bool RayTracer::is_covered(const Eigen::Vector3d& direction, const Sighting& from,
                           const Sighting& to, double tolerance_s) const {
  if (from.triangle == kNothing || to.triangle == kNothing) return true;
  if (inside(direction, from.triangle, to.t_s) >= 0 ||
      inside(direction, to.triangle, from.t_s) >= 0)
    return true;
  const double t_s = change_s(direction, from, to, tolerance_s);
  return !std::isnan(t_s) && std::min(inside(direction, from.triangle, t_s),
                                      inside(direction, to.triangle, t_s)) > -kAtEdge;
}

bool RayTracer::is_crease(const Eigen::Vector3d& direction, TriangleId a, TriangleId b,
                          double t_s) const {
  constexpr double kSamePoint = 1e-6;  // of the distance
  const Ray ray = ray_at(direction, t_s);
  if (std::min(scene_.inside(ray, a), scene_.inside(ray, b)) < -kAtEdge) return false;
  const double first = scene_.look(ray, a).distance;
  const double second = scene_.look(ray, b).distance;
  return std::abs(first - second) < kSamePoint * first;
}

}  // namespace saccade
