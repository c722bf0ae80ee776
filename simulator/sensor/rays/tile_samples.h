#pragma once

#include <array>
#include <bitset>
#include <cstddef>
#include <span>

#include "simulator/sensor/rays/pixel_rays.h"
#include "simulator/sensor/rays/ray_tracer.h"
#include "simulator/sensor/signal/pixel_signal.h"

namespace saccade {

using PixelSet = std::bitset<kMaxTilePixels>;

/// What the rays of a tile see at an instant, pixel by pixel: which triangles, and, where it is
/// asked for, what of them.
template <std::size_t kRays>
struct TileSamples {
  using Triangles = std::array<TriangleId, kMaxTilePixels * kRays>;

  double t_s;
  Triangles triangles;
  PixelSet sampled;  ///< whose samples are known
  std::array<RaySample, kMaxTilePixels * kRays> samples;

  /// The visible triangles are known.
  void set_triangles(const Triangles& seen, double at_s) {
    t_s = at_s;
    triangles = seen;
    sampled.reset();
  }

  /// Traces the rays of `pixels`, packet by packet. Of the other pixels nothing is known then.
  void trace(RayTracer& tracer, std::span<const Eigen::Vector3d> directions, double at_s,
             const PixelSet& pixels);

  /// Samples what `pixels` see, of which the triangles are known.
  void sample_surfaces(RayTracer& tracer, std::span<const Eigen::Vector3d> directions,
                       const PixelSet& pixels);

  /// Of pixel `i`; needs the samples.
  [[nodiscard]] PixelSample<kRays> sample(std::size_t i, double log_eps) const {
    PixelSample<kRays> sample;
    sample.t_s = t_s;
    for (std::size_t k = 0; k < kRays; ++k) sample.rays[k] = samples[i * kRays + k];
    sample.log_intensity = log_intensity(sample.radiance(), log_eps);
    return sample;
  }
};

template <std::size_t kRays>
void TileSamples<kRays>::trace(RayTracer& tracer, std::span<const Eigen::Vector3d> directions,
                               double at_s, const PixelSet& pixels) {
  t_s = at_s;
  triangles.fill(kNothing);
  sampled.reset();
  std::array<Eigen::Vector3d, kRayPacket> rays;
  std::array<std::size_t, kRayPacket> owners;
  std::array<TriangleId, kRayPacket> seen;
  std::size_t n = 0;
  const auto flush = [&] {
    tracer.find_triangles({rays.data(), n}, t_s, {seen.data(), n});
    for (std::size_t m = 0; m < n; ++m) triangles[owners[m]] = seen[m];
    n = 0;
  };
  for (std::size_t k = 0; k < directions.size(); ++k) {
    if (!pixels[k / kRays]) continue;
    rays[n] = directions[k];
    owners[n++] = k;
    if (n == kRayPacket) flush();
  }
  if (n > 0) flush();
}

template <std::size_t kRays>
void TileSamples<kRays>::sample_surfaces(RayTracer& tracer,
                                         std::span<const Eigen::Vector3d> directions,
                                         const PixelSet& pixels) {
  const PixelSet missing = pixels & ~sampled;
  sampled |= missing;
  // Neighbours in one go: they see the same triangles.
  const std::size_t count = directions.size() / kRays;
  for (std::size_t first = 0; first < count; ++first) {
    if (!missing[first]) continue;
    std::size_t last = first + 1;
    while (last < count && missing[last]) ++last;
    const std::size_t at = first * kRays;
    const std::size_t n = (last - first) * kRays;
    tracer.sample(directions.subspan(at, n), {&triangles[at], n}, t_s, {&samples[at], n});
    first = last;
  }
}

}  // namespace saccade
