#include "tests/support/brute_force.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "core/process/parallel.h"
#include "simulator/sensor/event_camera.h"
#include "simulator/sensor/image_renderer.h"
#include "simulator/sensor/pixel/event_pixel.h"
#include "simulator/sensor/rays/pixel_rays.h"
#include "simulator/sensor/rays/tile_trace.h"

namespace saccade::testing {
namespace {

constexpr double kBracket_s = 1e-9;
/// Next to an edge rays may slip through for less than this.
constexpr double kShortest_s = 1e-7;
constexpr double kMaxTexels = 0.1;

/// What a pixel sees at one instant through all its rays.
struct Look {
  double t_s = 0;
  double log_intensity = 0;
  std::vector<TriangleId> triangles;
  std::vector<Eigen::Vector2d> texels;
};

/// A pixel looked at with a packet of rays per time, whatever was seen before.
class BrutePixel {
 public:
  BrutePixel(const Scene& scene, const Spline& motion, const PixelRays& rays,
             std::span<const Eigen::Vector3d> directions, const EventOptions& options)
      : scene_(scene),
        motion_(motion),
        rays_(rays),
        directions_(directions),
        log_eps_(options.log_eps),
        filters_(options.texture_filter == TextureFilter::kMipmap) {}

  [[nodiscard]] Look at(double t_s) const { return at(t_s, motion_.pose(t_s)); }

  [[nodiscard]] Look at(double t_s, const Rigid3& pose) const {
    std::vector<TriangleId> triangles(directions_.size());
    scene_.visible(rays_at(t_s, pose), triangles);
    return look_at(t_s, pose, std::move(triangles));
  }

  /// With visibility in double precision.
  [[nodiscard]] Look exactly_at(double t_s) const {
    const Rigid3 pose = motion_.pose(t_s);
    std::vector<TriangleId> triangles;
    for (const Ray& ray : rays_at(t_s, pose)) triangles.push_back(scene_.visible_exactly(ray));
    return look_at(t_s, pose, std::move(triangles));
  }

  [[nodiscard]] Look between(const Look& a, const Look& b) const {
    return at(0.5 * (a.t_s + b.t_s));
  }

  /// The two samples, a nanosecond apart, between which `is_before` turns false; true at `lo`,
  /// false at `hi`.
  template <class IsBefore>
  [[nodiscard]] std::pair<Look, Look> bisect(Look lo, Look hi, const IsBefore& is_before) const {
    while (hi.t_s - lo.t_s > kBracket_s) {
      Look middle = exactly_at(0.5 * (lo.t_s + hi.t_s));
      (is_before(middle) ? lo : hi) = std::move(middle);
    }
    return {lo, hi};
  }

  /// The look of the highest (`sign` = 1) or lowest (-1) signal of an unimodal stretch.
  [[nodiscard]] Look extremum(Look a, Look b, double sign) const {
    while (b.t_s - a.t_s > 10 * kBracket_s) {
      Look left = at(a.t_s + (b.t_s - a.t_s) / 3);
      Look right = at(a.t_s + 2 * (b.t_s - a.t_s) / 3);
      if (sign * left.log_intensity > sign * right.log_intensity)
        b = std::move(right);
      else
        a = std::move(left);
    }
    return between(a, b);
  }

 private:
  [[nodiscard]] std::vector<Ray> rays_at(double t_s, const Rigid3& pose) const {
    std::vector<Ray> rays;
    for (const Eigen::Vector3d& direction : directions_)
      rays.push_back({pose.translation(), pose.rotation() * direction, t_s});
    return rays;
  }

  /// The visible triangles are known.
  [[nodiscard]] Look look_at(double t_s, const Rigid3& pose,
                             std::vector<TriangleId> triangles) const {
    const std::vector<Ray> rays = rays_at(t_s, pose);
    Look look{t_s, 0, std::move(triangles), {}};
    double sum = 0;
    for (std::size_t k = 0; k < rays.size(); ++k) {
      sum += radiance(rays[k], look.triangles[k], pose, directions_[k]);
      const SurfaceSample surface = scene_.sample_surface(rays[k], look.triangles[k]);
      look.texels.emplace_back(surface.texture != nullptr ? Eigen::Vector2d(surface.x, surface.y)
                                                          : Eigen::Vector2d(0, 0));
    }
    look.log_intensity = std::log(log_eps_ + sum / static_cast<double>(rays.size()));
    return look;
  }

  [[nodiscard]] double radiance(const Ray& ray, TriangleId triangle, const Rigid3& pose,
                                const Eigen::Vector3d& direction) const {
    if (!filters_) return scene_.shade(ray, triangle).radiance;
    return scene_
        .shade(ray, triangle, differential_in_world(rays_, pose.rotation_matrix(), direction))
        .radiance;
  }

  const Scene& scene_;
  const Spline& motion_;
  const PixelRays& rays_;
  std::span<const Eigen::Vector3d> directions_;
  double log_eps_;
  bool filters_;
};

/// Fires along looks that come in order.
class BruteSensor {
 public:
  BruteSensor(const BrutePixel& pixel, const Contrast& contrast, Look first)
      : pixel_(pixel),
        contrast_(contrast),
        state_(first.log_intensity, contrast),
        last_(std::move(first)) {}

  void advance(Look to) {
    if (last_.triangles != to.triangles) to = pixel_.exactly_at(to.t_s);
    while (last_.triangles != to.triangles) {
      const auto same = [&](const Look& look) { return look.triangles == last_.triangles; };
      const auto [lo, hi] = pixel_.bisect(last_, to, same);
      advance_on_surface(lo, 0);
      const Look later = pixel_.exactly_at(std::min(hi.t_s + kShortest_s, to.t_s));
      fire_up_to(later);
      has_previous_ = false;
    }
    advance_on_surface(to, 0);
  }

  /// Time and polarity.
  std::vector<std::pair<double, int>> fired;

 private:
  void advance_on_surface(const Look& to, int depth) {
    constexpr int kDeepest = 12;
    double farthest = 0;
    for (std::size_t k = 0; k < to.texels.size(); ++k)
      farthest = std::max(farthest, (to.texels[k] - last_.texels[k]).cwiseAbs().maxCoeff());
    if (farthest > kMaxTexels && depth < kDeepest && to.t_s - last_.t_s > 2 * kBracket_s) {
      const Look middle = pixel_.between(last_, to);
      if (middle.triangles == last_.triangles) {
        advance_on_surface(middle, depth + 1);
        advance_on_surface(to, depth + 1);
      } else {
        advance(middle);
        advance(to);
      }
      return;
    }
    step(to);
  }

  void step(const Look& to) {
    if (has_previous_) {
      const double before = last_.log_intensity - previous_.log_intensity;
      const double after = to.log_intensity - last_.log_intensity;
      const double sign = before > 0 ? 1 : -1;
      const double threshold = sign > 0 ? state_.band().upper : state_.band().lower;
      const double reach = std::max(std::abs(before), std::abs(after));
      if (before * after < 0 && std::abs(last_.log_intensity - threshold) < reach) {
        // The extremum is on one side of the look in the middle; what lies before that has been
        // passed already and is gone back to.
        const Look peak = pixel_.extremum(previous_, to, sign);
        if (peak.triangles == last_.triangles && !state_.band().contains(peak.log_intensity)) {
          if (peak.t_s < last_.t_s) last_ = previous_;
          fire_up_to(peak);
        }
      }
    }
    previous_ = last_;
    has_previous_ = true;
    fire_up_to(to);
  }

  void fire_up_to(const Look& to) {
    while (!state_.band().contains(to.log_intensity)) {
      const int polarity = to.log_intensity >= state_.band().upper ? 1 : -1;
      const auto [lo, hi] = pixel_.bisect(last_, to, [&](const Look& look) {
        return polarity > 0 ? look.log_intensity < state_.band().upper
                            : look.log_intensity > state_.band().lower;
      });
      state_.fire(polarity, contrast_);
      fired.emplace_back(hi.t_s, polarity);
      last_ = lo;
    }
    last_ = to;
  }

  const BrutePixel& pixel_;
  Contrast contrast_;
  EventPixel state_;
  Look last_;
  Look previous_;  ///< on the same surfaces, right before the last one
  bool has_previous_ = false;
};

std::span<const Eigen::Vector3d> directions_of(const PixelRays& rays, int x, int y) {
  const auto tile = static_cast<std::size_t>(y / kTileSize * rays.tiles_x() + x / kTileSize);
  const auto pixel =
      static_cast<std::size_t>(y % kTileSize * rays.tile(tile).width + x % kTileSize);
  return rays.rays(tile).subspan(pixel * rays.rays_per_pixel(), rays.rays_per_pixel());
}

/// use(x, y) for all pixels, in parallel.
template <class Use>
void for_each_pixel(const PinholeCamera& camera, const Use& use) {
  parallel_for(static_cast<std::size_t>(camera.width * camera.height), [&](std::size_t index) {
    use(static_cast<int>(index) % camera.width, static_cast<int>(index) / camera.width, index);
  });
}

}  // namespace

Events brute_force(const Scene& scene, const Spline& motion, const PinholeCamera& camera,
                   const EventOptions& options, double step_s) {
  const PixelRays rays(camera, options.samples_per_pixel);
  const double end_s = motion.end_s();
  std::vector<StampedPose> grid;
  const auto steps = static_cast<int>(std::ceil(end_s / step_s));
  for (int k = 0; k <= steps; ++k) {
    const double t_s = std::min(step_s * k, end_s);
    grid.push_back({t_s, motion.pose(t_s)});
  }
  std::vector<Events> per_pixel(static_cast<std::size_t>(camera.width * camera.height));
  for_each_pixel(camera, [&](int x, int y, std::size_t index) {
    const BrutePixel pixel(scene, motion, rays, directions_of(rays, x, y), options);
    BruteSensor sensor(pixel, options.contrast, pixel.at(0));
    for (std::size_t k = 1; k < grid.size(); ++k)
      sensor.advance(pixel.at(grid[k].t_s, grid[k].world_from_camera));
    for (const auto& [t_s, polarity] : sensor.fired)
      per_pixel[index].push_back({ns_from_seconds(t_s), static_cast<std::uint16_t>(x),
                                  static_cast<std::uint16_t>(y),
                                  static_cast<std::int8_t>(polarity)});
  });
  Events events;
  for (const Events& some : per_pixel) events.insert(events.end(), some.begin(), some.end());
  std::sort(events.begin(), events.end(), EventOrder());
  return events;
}

std::vector<double> log_intensities(const Scene& scene, const Spline& motion,
                                    const PinholeCamera& camera, int x, int y,
                                    const EventOptions& options, std::span<const double> times_s) {
  const PixelRays rays(camera, options.samples_per_pixel);
  const BrutePixel pixel(scene, motion, rays, directions_of(rays, x, y), options);
  std::vector<double> values;
  for (const double t_s : times_s) values.push_back(pixel.at(t_s).log_intensity);
  return values;
}

std::size_t count_pairs(const Events& a, const Events& b, TimeNs tolerance_ns) {
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

double Agreement::share(std::size_t pairs) const {
  const std::size_t most = std::max(found, expected);
  return most == 0 ? 1 : static_cast<double>(pairs) / static_cast<double>(most);
}

double Agreement::rays_per_event() const {
  return static_cast<double>(statistics.rays) /
         static_cast<double>(std::max<std::size_t>(found, 1));
}

std::string Agreement::text() const {
  return fmt::format(
      "{} events, {} by brute force; least of precision and recall {:.5f} at 10 us, {:.5f} at 1 "
      "us; "
      "{:.2f} rays and {:.2f} surface looks per event",
      found, expected, share_10_us(), share_1_us(), rays_per_event(),
      static_cast<double>(statistics.surface_samples) /
          static_cast<double>(std::max<std::size_t>(found, 1)));
}

Recorded record(const Scene& scene, const Spline& motion, const PinholeCamera& camera,
                const EventOptions& options) {
  Recorded recorded;
  EventCamera sensor(scene, motion, camera, options);
  sensor.record(motion.end_s(), [&](std::span<const SensedEvent> some, double) {
    for (const SensedEvent& event : some) recorded.events.push_back(event.event());
  });
  recorded.statistics = sensor.statistics();
  return recorded;
}

Agreement agreement(const Scene& scene, const Spline& motion, const PinholeCamera& camera,
                    EventOptions options, double step_s) {
  options.timestamp_unit = TimestampUnit::kNanoseconds;
  const Recorded recorded = record(scene, motion, camera, options);
  const Events truth = brute_force(scene, motion, camera, options, step_s);
  Agreement result;
  result.found = recorded.events.size();
  result.expected = truth.size();
  result.at_10_us = count_pairs(recorded.events, truth, 10'000);
  result.at_1_us = count_pairs(recorded.events, truth, 1'000);
  result.statistics = recorded.statistics;
  return result;
}

double mean_path_px(const Scene& scene, const Spline& motion, const PinholeCamera& camera) {
  constexpr int kInstants = 20;
  const ImageRenderer renderer(scene, camera, 1);
  double sum = 0;
  for (int k = 0; k < kInstants; ++k) {
    const double t_s = motion.end_s() * (k + 0.5) / kInstants;
    const FlowField flow = renderer.flow(motion.state(t_s), t_s);
    for (int y = 0; y < camera.height; ++y)
      for (int x = 0; x < camera.width; ++x)
        sum += std::hypot(static_cast<double>(flow.u(x, y)), static_cast<double>(flow.v(x, y)));
  }
  return sum / (kInstants * camera.width * camera.height) * motion.end_s();
}

double reconstruction_excess(const Scene& scene, const Spline& motion, const PinholeCamera& camera,
                             const EventOptions& options, const Events& events, double step_s,
                             double tolerance_s) {
  const auto pixels = static_cast<std::size_t>(camera.width * camera.height);
  std::vector<Events> per_pixel(pixels);
  for (const Event& event : events)
    per_pixel[static_cast<std::size_t>(event.y * camera.width + event.x)].push_back(event);
  std::vector<double> times_s;
  for (double t_s = 0; t_s <= motion.end_s(); t_s += step_s) times_s.push_back(t_s);
  std::vector<double> excess(pixels);
  const TimeNs tolerance_ns = ns_from_seconds(tolerance_s);
  for_each_pixel(camera, [&](int x, int y, std::size_t index) {
    const std::vector<double> truth =
        log_intensities(scene, motion, camera, x, y, options, times_s);
    const Events& mine = per_pixel[index];
    double level = truth[0];  // after all events that came for certain
    std::size_t done = 0;
    for (std::size_t k = 0; k < times_s.size(); ++k) {
      const TimeNs now = ns_from_seconds(times_s[k]);
      const auto step = [&](const Event& event) {
        return event.polarity > 0 ? options.contrast.on : -options.contrast.off;
      };
      for (; done < mine.size() && mine[done].t_ns < now - tolerance_ns; ++done)
        level += step(mine[done]);
      const auto beyond = [&](double value) {
        return truth[k] > value ? truth[k] - value - options.contrast.on
                                : value - truth[k] - options.contrast.off;
      };
      double best = beyond(level);
      double value = level;
      for (std::size_t i = done; i < mine.size() && mine[i].t_ns <= now + tolerance_ns; ++i)
        best = std::min(best, beyond(value += step(mine[i])));
      excess[index] = std::max(excess[index], best);
    }
  });
  return *std::max_element(excess.begin(), excess.end());
}

}  // namespace saccade::testing
