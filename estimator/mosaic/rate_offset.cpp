#include "estimator/mosaic/rate_offset.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <utility>

#include "core/panorama.h"
#include "core/process/parallel.h"
#include "estimator/reconstruction/observations/panorama_projector.h"
#include "estimator/run/pose_table.h"

namespace saccade {
namespace {

/// Resolutions of the panorama, each half of the next.
constexpr int kPyramidLevels = 3;
/// Bound on a component of the error [rad/s], twice the bias of a consumer gyroscope: a panorama
/// that collapses is sharp, too.
constexpr double kMaxRateOffset = 0.2;

Events subsampled(std::span<const Event> events, std::size_t most) {
  const std::size_t every = events.size() / most + 1;
  Events sample;
  for (std::size_t i = 0; i < events.size(); i += every) sample.push_back(events[i]);
  return sample;
}

/// Contrast of the image of events in one panorama.
class PanoramaContrast {
 public:
  PanoramaContrast(std::span<const Event> events, const PinholeCamera& camera,
                   const Trajectory& world_from_camera, const Panorama& panorama)
      : events_(events),
        poses_(world_from_camera),
        panorama_(panorama),
        projector_(camera, panorama) {}

  [[nodiscard]] double operator()(const Eigen::Vector3d& rate) const {
    const double start_s = seconds_from_ns(events_.front().t_ns);
    const PoseTable poses(without_rate(poses_, rate, start_s), Rigid3(), events_.front().t_ns,
                          events_.back().t_ns);
    // Two images, so that two threads have something to do where there is one rate to look at.
    std::array<ImageF, 2> halves;
    parallel_for(halves.size(), [&](std::size_t k) {
      const std::size_t begin = k * events_.size() / halves.size();
      const std::size_t end = (k + 1) * events_.size() / halves.size();
      halves[k] = image_of(events_.subspan(begin, end - begin), poses);
    });
    double sum = 0;
    for (std::size_t i = 0; i < halves[0].size(); ++i) {
      const auto count = static_cast<double>(halves[0].pixels()[i] + halves[1].pixels()[i]);
      sum += count * count;
    }
    return sum;
  }

 private:
  [[nodiscard]] ImageF image_of(std::span<const Event> events, const PoseTable& poses) const {
    // A pixel beyond the last column of a panorama that wraps is at its border.
    ImageF image(panorama_.width, panorama_.height);
    for (const Event& event : events) {
      const auto p = projector_.find(event.x, event.y, poses.at(event.t_ns));
      if (p && is_inside(image, p->x, p->y)) splat(image, p->x, p->y, 1.0F);
    }
    return image;
  }

  std::span<const Event> events_;
  const Trajectory& poses_;
  Panorama panorama_;
  PanoramaProjector projector_;
};

/// Maximises along the three axes by parabolas through points at distance `step`, which shrinks where
/// nothing improves.
Eigen::Vector3d maximise(const PanoramaContrast& contrast, Eigen::Vector3d rate, double step) {
  constexpr int kMaxIterations = 40;
  const double least = step / 16;
  double here = contrast(rate);
  for (int i = 0; i < kMaxIterations && step > least; ++i) {
    std::array<Eigen::Vector3d, 6> moves;
    for (std::size_t k = 0; k < moves.size(); ++k) {
      const auto axis = static_cast<int>(k / 2);
      const double to = rate[axis] + (k % 2 == 0 ? step : -step);
      moves[k] = (std::clamp(to, -kMaxRateOffset, kMaxRateOffset) - rate[axis]) *
                 Eigen::Vector3d::Unit(axis);
    }
    std::array<double, 6> values{};
    parallel_for(values.size(), [&](std::size_t k) { values[k] = contrast(rate + moves[k]); });
    Eigen::Vector3d move;
    for (Eigen::Index axis = 0; axis < 3; ++axis) {
      const auto k = 2 * static_cast<std::size_t>(axis);
      const double up = values[k], down = values[k + 1];
      const double curvature = up + down - 2 * here;
      const double top = curvature < 0 ? (down - up) / (2 * curvature) : (up > down ? 2.0 : -2.0);
      const double to = rate[axis] + step * std::clamp(top, -2.0, 2.0);
      move[axis] = std::clamp(to, -kMaxRateOffset, kMaxRateOffset) - rate[axis];
    }
    const double there = contrast(rate + move);
    const auto best = std::max_element(values.begin(), values.end());
    if (there > std::max(here, *best)) {
      rate += move;
      here = there;
      if (move.norm() < step) step /= 2;
    } else if (*best > here) {
      rate += moves[static_cast<std::size_t>(best - values.begin())];
      here = *best;
    } else {
      step /= 2;
    }
  }
  return rate;
}

}  // namespace

std::vector<Eigen::Matrix3d> orientations_of(const Trajectory& world_from_camera,
                                             std::span<const Event> events) {
  constexpr TimeNs kIntervalNs = 1'000'000;
  std::vector<Eigen::Matrix3d> orientations;
  const TimeNs end_ns = events.back().t_ns;
  const auto add = [&](TimeNs t_ns) {
    orientations.push_back(world_from_camera.at_clamped(seconds_from_ns(t_ns)).rotation_matrix());
  };
  for (TimeNs t_ns = events.front().t_ns; t_ns < end_ns; t_ns += kIntervalNs) add(t_ns);
  add(end_ns);
  return orientations;
}

Trajectory without_rate(const Trajectory& world_from_camera, const Eigen::Vector3d& rate,
                        double start_s) {
  const auto poses = world_from_camera.poses();
  std::vector<StampedPose> result(poses.begin(), poses.end());
  const std::size_t start = world_from_camera.last_before(start_s).value_or(0);
  const auto corrected = [&](std::size_t i, std::size_t from) {
    const Eigen::Quaterniond between = poses[from].world_from_camera.rotation().conjugate() *
                                       poses[i].world_from_camera.rotation();
    const double dt_s = poses[i].t_s - poses[from].t_s;
    result[i].world_from_camera =
        Rigid3(result[from].world_from_camera.rotation() * between * so3_exp(-dt_s * rate),
               poses[i].world_from_camera.translation());
  };
  for (std::size_t i = start + 1; i < poses.size(); ++i) corrected(i, i - 1);
  for (std::size_t i = start; i-- > 0;) corrected(i, i + 1);
  return Trajectory(std::move(result));
}

Eigen::Vector3d sharpest_rate_offset(std::span<const Event> events, const PinholeCamera& camera,
                                     const Trajectory& world_from_camera, double pixels_per_radian,
                                     std::size_t max_events) {
  const double duration_s =
      std::max(seconds_from_ns(events.back().t_ns - events.front().t_ns), 1e-3);
  const auto orientations = orientations_of(world_from_camera, events);
  Eigen::Vector3d rate = Eigen::Vector3d::Zero();
  for (int level = kPyramidLevels - 1; level >= 0; --level) {
    // A coarse panorama has fewer pixels to tell apart, and what it finds is where the next one begins.
    const Events sample = subsampled(events, std::max<std::size_t>(max_events >> level, 1));
    const Panorama panorama =
        panorama_around(FieldOfView(camera), orientations, pixels_per_radian / (1 << level));
    // One pixel between the first and the last event.
    const double step = 1 / (panorama.pixels_per_radian() * duration_s);
    rate = maximise(PanoramaContrast(sample, camera, world_from_camera, panorama), rate, step);
  }
  return rate;
}

}  // namespace saccade
