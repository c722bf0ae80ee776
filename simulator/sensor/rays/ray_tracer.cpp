#include "simulator/sensor/rays/ray_tracer.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "core/check.h"
#include "simulator/scene/texture/normal_texture.h"
#include "simulator/sensor/rays/tile_trace.h"
#include "simulator/sensor/signal/cell_bounds.h"
#include "simulator/sensor/signal/mipmap_bounds.h"

namespace saccade {
namespace {

/// How far outside its edges a ray still counts as meeting a triangle at its border [barycentric].
constexpr double kAtEdge = 1e-3;
/// Rates are differences over this time: short against any motion, long against rounding.
constexpr double kDifference_s = 1e-7;

/// Where more triangles than this may hide a light from a patch, shadow rays are quicker.
constexpr std::size_t kMaxOccluders = 8192;
/// Of patches whose light is found in one go.
constexpr std::size_t kMaxPatches = 256;

RaySample with_rates(const SurfaceSample& now, const SurfaceSample& soon, double soon_s,
                     TriangleId triangle) {
  RaySample sample{triangle, now, 0, 0};
  if (soon.texture != now.texture || (soon.distance == 0) != (now.distance == 0)) return sample;
  sample.x_rate = (soon.x - now.x) / soon_s;
  sample.y_rate = (soon.y - now.y) / soon_s;
  sample.level_rate = (soon.level - now.level) / soon_s;
  return sample;
}

}  // namespace

void EventStatistics::add(const EventStatistics& other) {
  rays += other.rays;
  lit_points += other.lit_points;
  surface_samples += other.surface_samples;
  lost += other.lost;
  time_bound_s = std::max(time_bound_s, other.time_bound_s);
}

Ray RayTracer::ray_at(const Eigen::Vector3d& direction, double t_s) const {
  const CameraFrame camera = poses_->at(t_s);
  return {camera.position, camera.rotation * direction, t_s};
}

SurfaceSample RayTracer::sample_surface(const Eigen::Vector3d& direction, TriangleId triangle,
                                        const CameraFrame& camera, double t_s) const {
  const Ray ray{camera.position, camera.rotation * direction, t_s};
  if (footprints_ == nullptr) return scene_.sample_surface(ray, triangle);
  return scene_.sample_surface(ray, triangle,
                               differential_in_world(*footprints_, camera.rotation, direction));
}

RaySample RayTracer::sample(const Eigen::Vector3d& direction, TriangleId triangle, double t_s) {
  RaySample sample = sample_unlit(direction, triangle, t_s);
  if (scene_.is_lit()) {
    const Ray ray = ray_at(direction, t_s);
    illuminate({&ray, 1}, {&sample, 1});
  }
  return sample;
}

RaySample RayTracer::sample(const Eigen::Vector3d& direction, TriangleId triangle, LightSet lights,
                            double t_s) {
  RaySample sample = sample_unlit(direction, triangle, t_s);
  if (!scene_.is_lit()) return sample;
  sample.surface.lights = lights;
  scene_.set_light(ray_at(direction, t_s), triangle, sample.surface);
  return sample;
}

double RayTracer::difference_s(double t_s) const {
  return t_s + kDifference_s <= poses_->to_s() ? kDifference_s : -kDifference_s;
}

RaySample RayTracer::sample_unlit(const Eigen::Vector3d& direction, TriangleId triangle,
                                  double t_s) {
  ++statistics_.surface_samples;
  const double soon_s = difference_s(t_s);
  return with_rates(sample_surface(direction, triangle, poses_->at(t_s), t_s),
                    sample_surface(direction, triangle, poses_->at(t_s + soon_s), t_s + soon_s),
                    soon_s, triangle);
}

RadianceRange RayTracer::varying_light_range(const Eigen::Vector3d& direction,
                                             const RaySample& from, double from_s,
                                             const RaySample& to, double to_s) const {
  const Ray from_ray = ray_at(direction, from_s);
  const Ray middle_ray = ray_at(direction, 0.5 * (from_s + to_s));
  const Ray to_ray = ray_at(direction, to_s);
  std::optional<VectorRange> mapped;
  if (scene_.has_normal_map(from.triangle)) {
    mapped = normal_map_range(direction, from, from_s, to, to_s);
    if (!mapped) return {};
  }
  const auto light_of = [&](LightSet lights) {
    return scene_.light_range(from_ray, from.surface, middle_ray, to_ray, to.surface, from.triangle,
                              lights, mapped ? &*mapped : nullptr);
  };
  std::optional<SurfaceLightRange> light = light_of(from.surface.lights);
  if (!light) return {};
  // At the edge of a shadow the light is that of one end or the other.
  if (from.surface.lights != to.surface.lights) light->include(*light_of(to.surface.lights));
  RadianceRange range = saccade::radiance_range(from, to, to_s - from_s, &light->irradiance);
  const LightRange& mirrored = light->mirrored;
  range.add({mirrored.low, mirrored.high, mirrored.rate_low, mirrored.rate_high});
  return range;
}

RaySample RayTracer::normal_map_sample(const Eigen::Vector3d& direction, const RaySample& seen,
                                       double t_s) const {
  const double soon_s = difference_s(t_s);
  const SurfaceSample soon =
      sample_surface(direction, seen.triangle, poses_->at(t_s + soon_s), t_s + soon_s);
  const auto on_map = [&](const SurfaceSample& surface, double at_s) {
    const NormalTextureSample sample =
        scene_.sample_normal_map(ray_at(direction, at_s), seen.triangle, surface);
    return SurfaceSample{.texture = &sample.map->part(0),
                         .x = sample.x,
                         .y = sample.y,
                         .distance = surface.distance,
                         .level = sample.level};
  };
  return with_rates(on_map(seen.surface, t_s), on_map(soon, t_s + soon_s), soon_s, seen.triangle);
}

std::optional<VectorRange> RayTracer::normal_map_range(const Eigen::Vector3d& direction,
                                                       const RaySample& from, double from_s,
                                                       const RaySample& to, double to_s) const {
  constexpr double kMostTexels = 1e6;
  if (!(from.surface.distance > 0 && to.surface.distance > 0)) return std::nullopt;
  const double length_s = to_s - from_s;
  RaySample first = normal_map_sample(direction, from, from_s);
  RaySample last = normal_map_sample(direction, to, to_s);
  const Interval across = x_coordinate(first, last, length_s).values();
  const Interval down = y_coordinate(first, last, length_s).values();
  if (!(across.high - across.low < kMostTexels && down.high - down.low < kMostTexels))
    return std::nullopt;
  const NormalTexture& map =
      *scene_.sample_normal_map(ray_at(direction, from_s), from.triangle, from.surface).map;
  VectorRange ranges;
  for (std::size_t axis = 0; axis < ranges.size(); ++axis) {
    first.surface.texture = last.surface.texture = &map.part(axis);
    const TextureRange range = is_filtered(first, last) ? mipmap_range(first, last, length_s)
                                                        : texture_range(first, last, length_s);
    ranges[axis] = {range.values.low, range.values.high, range.rates.low, range.rates.high};
  }
  return ranges;
}

double RayTracer::split_fraction(const Eigen::Vector3d& direction, const RaySample& from,
                                 double from_s, const RaySample& to, double to_s) const {
  const double length_s = to_s - from_s;
  if (has_normal_maps_ && scene_.has_normal_map(from.triangle) && from.surface.distance > 0 &&
      to.surface.distance > 0 && from.surface.lights == to.surface.lights) {
    const RaySample first = normal_map_sample(direction, from, from_s);
    const RaySample last = normal_map_sample(direction, to, to_s);
    SplitPoint division;
    if (!is_filtered(first, last))
      division.consider_cell(x_coordinate(first, last, length_s),
                             y_coordinate(first, last, length_s));
    if (division.found()) return division.fraction();
  }
  return saccade::split_fraction(from, to, length_s);
}

void RayTracer::set_region(const std::array<Eigen::Vector3d, 4>& outline, double from_s,
                           double to_s) {
  finds_lighting_ = is_lit();
  lighting_count_ = 0;
  if (finds_lighting_) frusta_ = frusta_over(outline, from_s, to_s);
}

const PatchLighting* RayTracer::lighting_of(TriangleId triangle) {
  if (!finds_lighting_ || triangle == kNothing) return nullptr;
  for (std::size_t k = lighting_count_; k-- > 0;)
    if (known_[k].triangle == triangle) return known_[k].lighting();
  if (lighting_count_ == kMaxPatches) return nullptr;
  if (lighting_count_ == known_.size()) known_.emplace_back();
  KnownLighting& known = known_[lighting_count_++];
  known.triangle = triangle;
  const PatchLighting* lighting =
      scene_.find_lighting(triangle, frusta_, kMaxOccluders, known.patch);
  known.is_known = lighting == &known.patch;
  known.whole = known.is_known ? nullptr : lighting;
  return lighting;
}

Eigen::Vector3d RayTracer::point_at(const Eigen::Vector3d& direction, TriangleId triangle,
                                    double t_s) const {
  const Ray ray = ray_at(direction, t_s);
  const double distance = scene_.sample_surface(ray, triangle).distance;
  if (!(distance > 0)) return Eigen::Vector3d::Constant(std::numeric_limits<double>::quiet_NaN());
  return ray.origin + distance * ray.direction;
}

void RayTracer::illuminate(std::span<const Ray> rays, std::span<RaySample> samples) {
  std::array<Ray, kRayPacket> unknown;
  std::array<TriangleId, kRayPacket> triangles;
  std::array<SurfaceSample, kRayPacket> surfaces;
  std::array<std::size_t, kRayPacket> owners;
  std::size_t n = 0;
  for (std::size_t k = 0; k < rays.size(); ++k) {
    SurfaceSample& surface = samples[k].surface;
    if (const PatchLighting* lighting = lighting_of(samples[k].triangle);
        lighting && surface.distance > 0) {
      surface.lights = lighting->lights_at(rays[k].origin + surface.distance * rays[k].direction);
      scene_.set_light(rays[k], samples[k].triangle, surface);
      continue;
    }
    unknown[n] = rays[k];
    triangles[n] = samples[k].triangle;
    surfaces[n] = surface;
    owners[n++] = k;
  }
  if (n == 0) return;
  scene_.illuminate({unknown.data(), n}, {triangles.data(), n}, {surfaces.data(), n});
  for (std::size_t k = 0; k < n; ++k) samples[owners[k]].surface = surfaces[k];
  statistics_.lit_points += n;
}

void RayTracer::find_triangles(std::span<const Eigen::Vector3d> directions, double t_s,
                               std::span<TriangleId> triangles) {
  SACCADE_CHECK(directions.size() <= kRayPacket && triangles.size() == directions.size());
  const CameraFrame camera = poses_->at(t_s);
  std::array<Ray, kRayPacket> rays;
  for (std::size_t k = 0; k < directions.size(); ++k)
    rays[k] = {camera.position, camera.rotation * directions[k], t_s};
  scene_.visible({rays.data(), directions.size()}, triangles);
  statistics_.rays += directions.size();
}

void RayTracer::trace(std::span<const Eigen::Vector3d> directions, double t_s,
                      std::span<RaySample> samples) {
  std::array<TriangleId, kRayPacket> triangles;
  const std::span<TriangleId> seen(triangles.data(), directions.size());
  for (std::size_t k = 0; k < directions.size(); ++k) {
    const Ray ray = ray_at(directions[k], t_s);
    seen[k] = scene_.nearest_among(candidates_, ray);
    if (seen[k] != kNothing) continue;
    seen[k] = scene_.visible_exactly(ray);
    ++statistics_.rays;
  }
  sample(directions, seen, t_s, samples);
}

void RayTracer::sample(std::span<const Eigen::Vector3d> directions,
                       std::span<const TriangleId> triangles, double t_s,
                       std::span<RaySample> samples) {
  SACCADE_CHECK(triangles.size() == directions.size() && samples.size() == directions.size());
  const CameraFrame camera = poses_->at(t_s);
  const double soon_s = difference_s(t_s);
  const CameraFrame soon = poses_->at(t_s + soon_s);
  std::optional<PlaneSampler> plane;
  for (std::size_t k = 0; k < directions.size(); ++k) {
    const TriangleId triangle = triangles[k];
    if (footprints_ != nullptr || triangle == kNothing ||
        scene_.moving_object(triangle) != nullptr) {
      samples[k] =
          with_rates(sample_surface(directions[k], triangle, camera, t_s),
                     sample_surface(directions[k], triangle, soon, t_s + soon_s), soon_s, triangle);
      continue;
    }
    if (!plane || plane->triangle() != triangle)
      plane.emplace(scene_.texel_homography(triangle, camera.position, camera.rotation),
                    scene_.texel_homography(triangle, soon.position, soon.rotation), soon_s,
                    triangle);
    samples[k] = plane->at(directions[k]);
  }
  if (!scene_.is_lit()) return;
  std::array<Ray, kRayPacket> rays;
  for (std::size_t first = 0; first < directions.size(); first += kRayPacket) {
    const std::size_t n = std::min(kRayPacket, directions.size() - first);
    for (std::size_t k = 0; k < n; ++k)
      rays[k] = {camera.position, camera.rotation * directions[first + k], t_s};
    illuminate({rays.data(), n}, samples.subspan(first, n));
  }
}

InverseDepthRange RayTracer::inverse_depths(std::span<const Eigen::Vector3d> directions,
                                            std::span<const TriangleId> triangles,
                                            double t_s) const {
  const CameraFrame camera = poses_->at(t_s);
  InverseDepthRange range{std::numeric_limits<double>::infinity(), 0};
  EdgeFunctions plane;
  for (std::size_t k = 0; k < directions.size(); ++k) {
    double inverse = 0;
    if (triangles[k] != kNothing) {
      if (k == 0 || triangles[k] != triangles[k - 1])
        plane = scene_.edge_functions(triangles[k], camera.position, camera.rotation, t_s);
      inverse = std::max(plane.w.dot(directions[k]) / plane.depth, 0.0);
    }
    range.low = std::min(range.low, inverse);
    range.high = std::max(range.high, inverse);
  }
  return range;
}

PlaneSampler RayTracer::plane_sampler(TriangleId triangle, double t_s) const {
  const CameraFrame camera = poses_->at(t_s);
  const double soon_s = difference_s(t_s);
  const CameraFrame soon = poses_->at(t_s + soon_s);
  return {scene_.texel_homography(triangle, camera.position, camera.rotation),
          scene_.texel_homography(triangle, soon.position, soon.rotation), soon_s, triangle};
}

bool RayTracer::is_sole_visible(TriangleId triangle, const std::array<Eigen::Vector3d, 4>& outline,
                                double from_s, double to_s) const {
  const auto frusta = frusta_over(outline, from_s, to_s);
  return scene_.is_sole_visible(triangle, frusta);
}

bool RayTracer::collect(const std::array<Eigen::Vector3d, 4>& outline, double farthest_m,
                        double from_s, double to_s, std::size_t most,
                        std::vector<TriangleId>& found) const {
  const auto frusta = frusta_over(outline, from_s, to_s);
  return scene_.collect(frusta, farthest_m, most, found);
}

auto RayTracer::frusta_over(const std::array<Eigen::Vector3d, 4>& outline, double from_s,
                            double to_s) const -> Frusta {
  Frusta frusta;
  const double step_s = (to_s - from_s) / static_cast<double>(frusta.size() - 1);
  for (std::size_t m = 0; m + 1 < frusta.size(); ++m)
    frusta[m] = frustum_at(outline, from_s + static_cast<double>(m) * step_s);
  frusta.back() = frustum_at(outline, to_s);
  return frusta;
}

Frustum RayTracer::frustum_at(const std::array<Eigen::Vector3d, 4>& outline, double t_s) const {
  const CameraFrame camera = poses_->at(t_s);
  Frustum frustum{camera.position, {}, t_s};
  for (std::size_t k = 0; k < outline.size(); ++k)
    frustum.corners[k] = camera.rotation * outline[k];
  return frustum;
}

std::vector<OpacityInterval> RayTracer::find_opacity_intervals(const Eigen::Vector3d& direction,
                                                               TriangleId triangle, double from_s,
                                                               double to_s) const {
  constexpr double kSamplesPerTexel = 4;
  constexpr double kMaxSamples = 64;
  const auto sample = [&](double t_s) {
    return scene_.sample_cutout(ray_at(direction, t_s), triangle);
  };
  const CutoutSample first = sample(from_s);
  const CutoutSample last = sample(to_s);
  const double texels = std::max(std::abs(last.x - first.x), std::abs(last.y - first.y));
  const double steps = std::clamp(std::ceil(kSamplesPerTexel * texels), 4.0, kMaxSamples);
  const auto opacity = [&](double t_s) { return sample(t_s).opacity; };
  return OpacitySearch(opacity, {from_s, first.opacity}, {to_s, last.opacity},
                       static_cast<std::size_t>(steps))
      .intervals();
}

bool RayTracer::is_nearest(const Eigen::Vector3d& direction, TriangleId triangle,
                           std::span<const TriangleId> among, double t_s) const {
  return scene_.nearest_among(among, ray_at(direction, t_s)) == triangle;
}

double RayTracer::min_barycentric(const Eigen::Vector3d& direction, TriangleId triangle,
                                  double t_s) const {
  return scene_.min_barycentric(ray_at(direction, t_s), triangle);
}

double RayTracer::change_s(const Eigen::Vector3d& direction, const VisibleTriangle& from,
                           const VisibleTriangle& to, double tolerance_s) const {
  TriangleId triangle = from.triangle;
  double a_s = from.t_s, b_s = to.t_s;
  double a = min_barycentric(direction, triangle, a_s);
  double b = min_barycentric(direction, triangle, b_s);
  if (!(b < 0)) {
    triangle = to.triangle;
    a = min_barycentric(direction, triangle, a_s);
    b = min_barycentric(direction, triangle, b_s);
  }
  if ((a < 0) == (b < 0)) return std::numeric_limits<double>::quiet_NaN();
  // False position, Illinois variant, on the smallest barycentric coordinate.
  constexpr int kMaxSteps = 20;
  double t = a_s;
  for (int k = 0, last = 0; k < kMaxSteps && b_s - a_s > tolerance_s; ++k) {
    const double before = t;
    t = a_s + (b_s - a_s) * std::clamp(a / (a - b), 0.001, 0.999);
    const double value = min_barycentric(direction, triangle, t);
    const bool is_first = (value < 0) == (a < 0);
    (is_first ? a_s : b_s) = t;
    (is_first ? a : b) = value;
    if (last == (is_first ? 1 : -1)) (is_first ? b : a) *= 0.5;
    last = is_first ? 1 : -1;
    if (std::abs(t - before) < tolerance_s) break;
  }
  return a_s + (b_s - a_s) * std::clamp(a / (a - b), 0.0, 1.0);
}

double RayTracer::change_near_s(const Eigen::Vector3d& direction, TriangleId triangle,
                                const Interval& span, double guess, double tolerance_s) const {
  constexpr double kNear = 1e-3;  // about as exact as a guess from a parabola is
  constexpr int kMaxSteps = 4;
  const double length_s = span.high - span.low;
  double a_s = span.low + guess * length_s;
  double b_s = a_s + (guess < 0.5 ? kNear : -kNear) * length_s;
  double a = min_barycentric(direction, triangle, a_s);
  double b = min_barycentric(direction, triangle, b_s);
  for (int k = 0; k < kMaxSteps; ++k) {
    const double t_s = b_s - b * ((b_s - a_s) / (b - a));
    if (!(t_s > span.low && t_s < span.high)) break;
    // The error of a step of the secant method, for slopes that change by no more than themselves.
    if (std::abs((t_s - a_s) * (t_s - b_s)) < tolerance_s * length_s) return t_s;
    a_s = b_s;
    a = b;
    b_s = t_s;
    b = min_barycentric(direction, triangle, t_s);
  }
  return std::numeric_limits<double>::quiet_NaN();
}

bool RayTracer::is_covered(const Eigen::Vector3d& direction, const VisibleTriangle& from,
                           const VisibleTriangle& to, double tolerance_s) const {
  if (from.triangle == kNothing || to.triangle == kNothing) return true;
  if (min_barycentric(direction, from.triangle, to.t_s) >= 0 ||
      min_barycentric(direction, to.triangle, from.t_s) >= 0)
    return true;
  const double t_s = change_s(direction, from, to, tolerance_s);
  return !std::isnan(t_s) && std::min(min_barycentric(direction, from.triangle, t_s),
                                      min_barycentric(direction, to.triangle, t_s)) > -kAtEdge;
}

bool RayTracer::is_crease(const Eigen::Vector3d& direction, TriangleId a, TriangleId b,
                          double t_s) const {
  constexpr double kSamePoint = 1e-6;  // of the distance
  const Ray ray = ray_at(direction, t_s);
  if (std::min(scene_.min_barycentric(ray, a), scene_.min_barycentric(ray, b)) < -kAtEdge)
    return false;
  const double first = scene_.sample_surface(ray, a).distance;
  const double second = scene_.sample_surface(ray, b).distance;
  return std::abs(first - second) < kSamePoint * first;
}

}  // namespace saccade
