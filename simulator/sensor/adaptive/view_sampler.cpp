#include "simulator/sensor/adaptive/view_sampler.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "core/check.h"
#include "simulator/sensor/rays/tile_trace.h"
#include "simulator/sensor/signal/ray_sample.h"

namespace saccade {
namespace {

/// One number for a sequence of them (FNV-1a over whole words).
void mix(std::uint64_t value, std::uint64_t& hash) { hash = (hash ^ value) * 0x100000001b3ULL; }

/// Adds one of a pixel's rays; the first tells where the pixel looks.
void add(const SurfaceSample& seen, TriangleId triangle, bool is_first, ViewSample& sample) {
  mix(triangle, sample.triangles);
  mix(seen.lights, sample.lights);
  if (!is_first) return;
  sample.distance = seen.distance;
  sample.x = seen.x;
  sample.y = seen.y;
  sample.level = seen.level;
  sample.factor = seen.factor;
  sample.irradiance = seen.irradiance;
  sample.mirrored = seen.mirrored;
  sample.triangle = triangle;
  sample.lights_of_ray = seen.lights;
}

}  // namespace

SurfaceSample ViewSampler::surface(const CameraFrame& camera, const Eigen::Vector3d& direction,
                                   const Ray& ray, TriangleId triangle) const {
  if (options_.texture_filter == TextureFilter::kBilinear)
    return scene_.sample_surface(ray, triangle);
  return scene_.sample_surface(ray, triangle,
                               differential_in_world(rays_, camera.rotation, direction));
}

void ViewSampler::trace(std::span<const SampleRequest> requests, std::span<ViewSample> samples) {
  SACCADE_CHECK(samples.size() == requests.size());
  const std::size_t per_pixel = rays_.rays_per_pixel();
  const std::size_t count = requests.size() * per_pixel;
  std::array<Ray, kRayPacket> rays;
  std::array<TriangleId, kRayPacket> triangles;
  std::array<SurfaceSample, kRayPacket> seen;
  std::fill(samples.begin(), samples.end(), ViewSample{});
  for (std::size_t first = 0; first < count; first += kRayPacket) {
    const std::size_t n = std::min(kRayPacket, count - first);
    const auto direction = [&](std::size_t k) -> const Eigen::Vector3d& {
      return directions(requests[k / per_pixel].pixel)[k % per_pixel];
    };
    const auto camera = [&](std::size_t k) -> const CameraFrame& {
      return camera_at(requests[(first + k) / per_pixel].t_s);
    };
    for (std::size_t k = 0; k < n; ++k)
      rays[k] = {camera(k).position, camera(k).rotation * direction(first + k),
                 requests[(first + k) / per_pixel].t_s};
    scene_.visible({rays.data(), n}, {triangles.data(), n});
    for (std::size_t k = 0; k < n; ++k)
      seen[k] = surface(camera(k), direction(first + k), rays[k], triangles[k]);
    scene_.illuminate({rays.data(), n}, {triangles.data(), n}, {seen.data(), n});
    for (std::size_t k = 0; k < n; ++k) {
      ViewSample& sample = samples[(first + k) / per_pixel];
      add(seen[k], triangles[k], (first + k) % per_pixel == 0, sample);
      if ((first + k) % per_pixel == 0) add_normal_map(rays[k], seen[k], sample);
      sample.radiance += seen[k].radiance();  // the sum, until all of them are there
    }
  }
  for (std::size_t i = 0; i < requests.size(); ++i) {
    samples[i].t_s = requests[i].t_s;
    samples[i].radiance /= static_cast<double>(per_pixel);
    samples[i].log_intensity = log_intensity(samples[i].radiance, options_.log_eps);
  }
  statistics_.rays += count;
  if (scene_.is_lit()) statistics_.lit_points += count;
}

void ViewSampler::add_normal_map(const Ray& ray, const SurfaceSample& seen,
                                 ViewSample& sample) const {
  if (!scene_.has_normal_map(sample.triangle) || !(seen.distance > 0)) return;
  const NormalTextureSample map = scene_.sample_normal_map(ray, sample.triangle, seen);
  sample.normal_x = map.x;
  sample.normal_y = map.y;
  sample.normal_level = map.level;
}

void ViewSampler::look(double t_s, std::span<TriangleId> triangles) {
  SACCADE_CHECK(rays_.rays_per_pixel() == 1 && triangles.size() <= kRayPacket);
  const CameraFrame& camera = camera_at(t_s);
  std::array<Ray, kRayPacket> rays;
  for (std::size_t i = 0; i < triangles.size(); ++i)
    rays[i] = {camera.position, camera.rotation * directions(i)[0], t_s};
  scene_.visible({rays.data(), triangles.size()}, triangles);
  statistics_.rays += triangles.size();
}

void ViewSampler::look_at_lights(std::span<const SampleRequest> requests,
                                 std::span<const ViewSample* const> like,
                                 std::span<const LightSet> among, std::span<LightSet> lights) {
  SACCADE_CHECK(rays_.rays_per_pixel() == 1 && requests.size() <= kRayPacket &&
                like.size() == requests.size() && among.size() == requests.size() &&
                lights.size() == requests.size());
  const std::size_t n = requests.size();
  std::array<Ray, kRayPacket> rays;
  std::array<TriangleId, kRayPacket> triangles;
  std::array<SurfaceSample, kRayPacket> seen;
  std::array<KnownLights, kRayPacket> known;
  for (std::size_t k = 0; k < n; ++k) {
    const CameraFrame& camera = camera_at(requests[k].t_s);
    rays[k] = {camera.position, camera.rotation * directions(requests[k].pixel)[0],
               requests[k].t_s};
    triangles[k] = like[k]->triangle;
    seen[k] = scene_.sample_surface(rays[k], triangles[k]);
    known[k] = {like[k]->lights_of_ray & ~among[k], ~like[k]->lights_of_ray & ~among[k]};
  }
  scene_.find_lights({rays.data(), n}, {triangles.data(), n}, {seen.data(), n}, {known.data(), n},
                     lights);
  statistics_.lit_points += n;
}

SurfaceSample ViewSampler::surface_like(const SampleRequest& request, const ViewSample& like) {
  SACCADE_CHECK(rays_.rays_per_pixel() == 1);
  const CameraFrame& camera = camera_at(request.t_s);
  const Eigen::Vector3d& direction = directions(request.pixel)[0];
  const Ray ray{camera.position, camera.rotation * direction, request.t_s};
  SurfaceSample seen = surface(camera, direction, ray, like.triangle);
  seen.lights = like.lights_of_ray;
  scene_.set_light(ray, like.triangle, seen);
  ++statistics_.surface_samples;
  return seen;
}

ViewSample ViewSampler::resample(const SampleRequest& request, const ViewSample& like) {
  const SurfaceSample seen = surface_like(request, like);
  ViewSample sample;
  add(seen, like.triangle, true, sample);
  if (scene_.has_normal_maps()) {
    const CameraFrame& camera = camera_at(request.t_s);
    add_normal_map({camera.position, camera.rotation * directions(request.pixel)[0], request.t_s},
                   seen, sample);
  }
  sample.triangles = like.triangles;
  sample.lights = like.lights;
  sample.t_s = request.t_s;
  sample.radiance = seen.radiance();
  sample.log_intensity = log_intensity(sample.radiance, options_.log_eps);
  return sample;
}

ViewSample ViewSampler::resample(const SampleRequest& request, const ViewSample& like,
                                 LightSet lights) {
  ViewSample lit = like;
  lit.lights_of_ray = lights;
  lit.lights = 0;
  mix(lights, lit.lights);
  return resample(request, lit);
}

bool ViewSampler::find_lights_between(std::size_t pixel, const ViewSample& from,
                                      const ViewSample& to, LightSet lights) {
  SACCADE_CHECK(from.triangle == to.triangle && rays_.rays_per_pixel() == 1);
  const bool is_found = way_.pixel == pixel && way_.triangle == from.triangle &&
                        way_.from_s <= from.t_s && to.t_s <= way_.to_s &&
                        (lights & ~way_.lights) == 0;
  if (is_found) return true;
  way_.triangle = kNothing;
  const Eigen::Vector3d eye = camera_at(from.t_s).position;
  if (!scene_.find_lighting_between(point_of(pixel, from), point_of(pixel, to), eye, from.triangle,
                                    lights, way_.lighting))
    return false;
  way_.pixel = pixel;
  way_.triangle = from.triangle;
  way_.lights = lights;
  way_.from_s = from.t_s;
  way_.to_s = to.t_s;
  return true;
}

void ViewSampler::settle_lights(std::size_t pixel, LightSet lights, ViewSample& sample) {
  SACCADE_CHECK(way_.pixel == pixel && way_.triangle == sample.triangle &&
                way_.from_s <= sample.t_s && sample.t_s <= way_.to_s);
  const LightSet open = lights & ~sample.settled;
  if (open == 0) return;
  const LightSet lit = way_.lighting.lights_at(point_of(pixel, sample)) & open;
  const LightSet known = (sample.lights_of_ray & ~open) | lit;
  const LightSet settled = sample.settled | lights;
  if (known != sample.lights_of_ray) sample = resample({pixel, sample.t_s}, sample, known);
  sample.settled = settled;
}

Eigen::Vector3d ViewSampler::point_of(std::size_t pixel, const ViewSample& sample) {
  const CameraFrame& camera = camera_at(sample.t_s);
  return camera.position + sample.distance * (camera.rotation * directions(pixel)[0]);
}

SurfaceArc ViewSampler::arc(std::size_t pixel, const ViewSample& from, const ViewSample& to) {
  const SurfaceSample middle = surface_like({pixel, 0.5 * (from.t_s + to.t_s)}, from);
  const auto end = [&](const ViewSample& seen) {
    return SurfaceSample{.texture = middle.texture,
                         .x = seen.x,
                         .y = seen.y,
                         .factor = seen.factor,
                         .irradiance = seen.irradiance,
                         .distance = seen.distance,
                         .level = seen.level,
                         .lights = seen.lights_of_ray,
                         .mirrored = seen.mirrored};
  };
  return {from.t_s, to.t_s, end(from), middle, end(to)};
}

double ViewSampler::mirrored_span(std::size_t pixel, const ViewSample& from, const ViewSample& to) {
  const auto ray_at = [&](double t_s) {
    const CameraFrame& camera = camera_at(t_s);
    return Ray{camera.position, camera.rotation * directions(pixel)[0], t_s};
  };
  const auto seen = [](const ViewSample& sample) {
    return SurfaceSample{.distance = sample.distance, .normal_level = sample.normal_level};
  };
  const auto range =
      scene_.light_range(ray_at(from.t_s), seen(from), ray_at(0.5 * (from.t_s + to.t_s)),
                         ray_at(to.t_s), seen(to), from.triangle, from.lights_of_ray);
  return range ? range->mirrored.high - range->mirrored.low : 0;
}

std::optional<ViewSample> ViewSampler::resample(const SampleRequest& request,
                                                const ViewSample& before, const ViewSample& after) {
  const CameraFrame& camera = camera_at(request.t_s);
  const Ray ray{camera.position, camera.rotation * directions(request.pixel)[0], request.t_s};
  const std::array<TriangleId, 2> triangles{before.triangle, after.triangle};
  const TriangleId nearest = scene_.nearest_among(triangles, ray);
  if (nearest != kNothing) return resample(request, nearest == before.triangle ? before : after);
  if (before.triangle == kNothing) return resample(request, before);
  if (after.triangle == kNothing) return resample(request, after);
  return std::nullopt;
}

}  // namespace saccade
