#pragma once

#include <algorithm>
#include <cmath>
#include <map>
#include <span>
#include <tuple>
#include <utility>
#include <vector>

#include "core/camera.h"
#include "core/event.h"
#include "core/parallel.h"
#include "core/spline.h"
#include "simulator/scene/scene.h"
#include "simulator/sensor/event_options.h"
#include "simulator/sensor/event_pixel.h"
#include "simulator/sensor/tile_trace.h"

namespace saccade::testing {

/// One pixel looked at with its rays per time, whatever was seen before.
class BrutePixel {
 public:
  struct Look {
    double t_s;
    double log_intensity;
    std::vector<TriangleId> triangles;
  };

  /// `directions`: the pixel's, of `rays`.
  BrutePixel(const Scene& scene, const Spline& motion, const PixelRays& rays,
             std::span<const Eigen::Vector3d> directions, const EventOptions& options)
      : scene_(scene), motion_(motion), rays_(rays), directions_(directions), options_(options) {}

  [[nodiscard]] Look at(double t_s) const {
    const Rigid3 pose = motion_.pose(t_s);
    Look look{t_s, 0, {}};
    double sum = 0;
    for (const Eigen::Vector3d& direction : directions_) {
      const Ray ray{pose.translation(), pose.rotation() * direction, t_s};
      TriangleId triangle;
      scene_.visible({&ray, 1}, {&triangle, 1});
      look.triangles.push_back(triangle);
      sum += radiance(pose, direction, ray, triangle);
    }
    look.log_intensity = std::log(options_.log_eps + sum / static_cast<double>(directions_.size()));
    return look;
  }

  /// The two looks, a nanosecond apart, between which `is_before` turns false; true at `lo`, false
  /// at `hi`.
  template <class IsBefore>
  [[nodiscard]] std::pair<Look, Look> bisect(Look lo, Look hi, const IsBefore& is_before) const {
    while (hi.t_s - lo.t_s > 1e-9) {
      const Look middle = at(0.5 * (lo.t_s + hi.t_s));
      (is_before(middle) ? lo : hi) = middle;
    }
    return {lo, hi};
  }

 private:
  [[nodiscard]] double radiance(const Rigid3& pose, const Eigen::Vector3d& direction,
                                const Ray& ray, TriangleId triangle) const {
    if (options_.texture_filter == TextureFilter::kBilinear)
      return scene_.shade(ray, triangle).radiance;
    const RaySpread spread = spread_in_world(rays_, pose.rotation_matrix(), direction);
    return scene_.shade(ray, triangle, spread).radiance;
  }

  const Scene& scene_;
  const Spline& motion_;
  const PixelRays& rays_;
  std::span<const Eigen::Vector3d> directions_;
  const EventOptions& options_;
};

/// What the event camera must agree with, made without any of its shortcuts: every pixel is traced
/// on a grid of `step_s`; the change of the visible triangle between two grid times, and every
/// crossing, are bisected. Sorted.
inline Events brute_force(const Scene& scene, const Spline& motion, const PinholeCamera& camera,
                          const EventOptions& options, double step_s) {
  const PixelRays rays(camera, options.samples_per_pixel);
  const std::size_t per_pixel = rays.rays_per_pixel();
  std::vector<Events> per_tile(rays.tile_count());
  const auto sense = [&](std::size_t index, std::size_t i) {
    const Tile tile = rays.tile(index);
    const BrutePixel pixel(scene, motion, rays, rays.rays(index).subspan(i * per_pixel, per_pixel),
                           options);
    BrutePixel::Look from = pixel.at(0);
    EventPixel state(from.log_intensity, options.contrast);
    const auto fire_up_to = [&](const BrutePixel::Look& to) {
      while (!state.band().holds(to.log_intensity)) {
        const int polarity = to.log_intensity >= state.band().upper ? 1 : -1;
        const auto [lo, hi] = pixel.bisect(from, to, [&](const BrutePixel::Look& look) {
          return polarity > 0 ? look.log_intensity < state.band().upper
                              : look.log_intensity > state.band().lower;
        });
        state.fire(polarity, options.contrast);
        per_tile[index].push_back({ns_from_seconds(hi.t_s), static_cast<std::uint16_t>(tile.x(i)),
                                   static_cast<std::uint16_t>(tile.y(i)),
                                   static_cast<std::int8_t>(polarity)});
        from = lo;
      }
      from = to;
    };
    const auto steps = static_cast<int>(std::ceil(motion.end_s() / step_s));
    for (int k = 1; k <= steps; ++k) {
      const BrutePixel::Look to = pixel.at(std::min(step_s * k, motion.end_s()));
      // One change per ray: rounding may let a ray flip between neighbours at their edge.
      for (std::size_t ray = 0; ray < per_pixel && to.triangles != from.triangles; ++ray) {
        const auto [lo, hi] = pixel.bisect(from, to, [&](const BrutePixel::Look& look) {
          return look.triangles == from.triangles;
        });
        fire_up_to(lo);
        fire_up_to(hi);
      }
      fire_up_to(to);
    }
  };
  parallel_for(rays.tile_count(), [&](std::size_t index) {
    for (std::size_t i = 0; i < rays.tile(index).pixels(); ++i) sense(index, i);
  });
  Events events;
  for (const Events& some : per_tile) events.insert(events.end(), some.begin(), some.end());
  std::sort(events.begin(), events.end(), EventOrder());
  return events;
}

/// Events of `a` and `b` that pair up one-to-one, in order, within `tolerance_ns`, per pixel and
/// polarity.
inline std::size_t count_pairs(const Events& a, const Events& b, TimeNs tolerance_ns) {
  using Key = std::tuple<int, int, int>;
  std::map<Key, std::pair<std::vector<TimeNs>, std::vector<TimeNs>>> times;
  for (const Event& e : a) times[{e.x, e.y, e.polarity}].first.push_back(e.t_ns);
  for (const Event& e : b) times[{e.x, e.y, e.polarity}].second.push_back(e.t_ns);
  std::size_t pairs = 0;
  for (const auto& [key, both] : times) {
    const auto& [first, second] = both;
    for (std::size_t i = 0, j = 0; i < first.size() && j < second.size();) {
      if (std::abs(first[i] - second[j]) <= tolerance_ns)
        ++pairs, ++i, ++j;
      else if (first[i] < second[j])
        ++i;
      else
        ++j;
    }
  }
  return pairs;
}

}  // namespace saccade::testing
