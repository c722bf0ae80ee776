#pragma once

#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>
#include <utility>
#include <vector>

#include "core/camera.h"
#include "core/event.h"
#include "core/parallel.h"
#include "core/spline.h"
#include "simulator/scene/scene.h"
#include "simulator/sensor/event_pixel.h"

namespace saccade::testing {

/// One pixel looked at with a ray per time, whatever was seen before.
class BrutePixel {
 public:
  struct Look {
    double t_s;
    double log_intensity;
    TriangleId triangle;
  };

  BrutePixel(const Scene& scene, const Spline& motion, const Eigen::Vector3d& direction,
             double log_eps)
      : scene_(scene), motion_(motion), direction_(direction), log_eps_(log_eps) {}

  [[nodiscard]] Look at(double t_s) const {
    const Rigid3 pose = motion_.pose(t_s);
    const Ray ray{pose.translation(), pose.rotation() * direction_};
    TriangleId triangle;
    scene_.visible({&ray, 1}, {&triangle, 1});
    return {t_s, std::log(log_eps_ + scene_.shade(ray, triangle).radiance), triangle};
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
  const Scene& scene_;
  const Spline& motion_;
  Eigen::Vector3d direction_;
  double log_eps_;
};

/// What the event camera must agree with, made without any of its shortcuts: every pixel is traced
/// on a grid of `step_s`; the change of the visible triangle between two grid times, and every
/// crossing, are bisected. Sorted.
inline Events brute_force(const Scene& scene, const Spline& motion, const PinholeCamera& camera,
                          const Contrast& contrast, double log_eps, double step_s) {
  const auto width = static_cast<std::size_t>(camera.width);
  std::vector<Events> per_pixel(width * static_cast<std::size_t>(camera.height));
  parallel_for(per_pixel.size(), [&](std::size_t index) {
    const int x = static_cast<int>(index % width);
    const int y = static_cast<int>(index / width);
    const BrutePixel pixel(scene, motion, camera.ray(camera.undistort({x, y})), log_eps);
    BrutePixel::Look from = pixel.at(0);
    EventPixel state(from.log_intensity, contrast);
    const auto fire_up_to = [&](const BrutePixel::Look& to) {
      while (!state.band().holds(to.log_intensity)) {
        const int polarity = to.log_intensity >= state.band().upper ? 1 : -1;
        const auto [lo, hi] = pixel.bisect(from, to, [&](const BrutePixel::Look& look) {
          return polarity > 0 ? look.log_intensity < state.band().upper
                              : look.log_intensity > state.band().lower;
        });
        state.fire(polarity, contrast);
        per_pixel[index].push_back({ns_from_seconds(hi.t_s), static_cast<std::uint16_t>(x),
                                    static_cast<std::uint16_t>(y),
                                    static_cast<std::int8_t>(polarity)});
        from = lo;
      }
      from = to;
    };
    const auto steps = static_cast<int>(std::ceil(motion.end_s() / step_s));
    for (int k = 1; k <= steps; ++k) {
      const BrutePixel::Look to = pixel.at(std::min(step_s * k, motion.end_s()));
      if (to.triangle != from.triangle) {
        const auto [lo, hi] = pixel.bisect(
            from, to, [&](const BrutePixel::Look& look) { return look.triangle == from.triangle; });
        fire_up_to(lo);
        fire_up_to(hi);
      }
      fire_up_to(to);
    }
  });
  Events events;
  for (const Events& some : per_pixel) events.insert(events.end(), some.begin(), some.end());
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
