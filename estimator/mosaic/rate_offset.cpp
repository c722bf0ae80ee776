#include "estimator/mosaic/rate_offset.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

#include "core/panorama.h"
#include "core/process/parallel.h"
#include "estimator/mosaic/swept.h"
#include "estimator/reconstruction/direction_finder.h"
#include "estimator/reconstruction/pose_table.h"

namespace saccade {
namespace {

Events some_of(std::span<const Event> events, int most) {
  const std::size_t every = events.size() / static_cast<std::size_t>(most) + 1;
  Events some;
  for (std::size_t i = 0; i < events.size(); i += every) some.push_back(events[i]);
  return some;
}

/// How sharply events fall together in one panorama.
class Sharpness {
 public:
  Sharpness(std::span<const Event> events, const PinholeCamera& camera,
            const Trajectory& world_from_camera, const Panorama& panorama)
      : events_(events),
        poses_(world_from_camera),
        panorama_(panorama),
        places_(camera, panorama) {}

  [[nodiscard]] double operator()(const Eigen::Vector3d& rate) const {
    const double start_s = seconds_from_ns(events_.front().t_ns);
    const PoseTable poses(without_rate(poses_, rate, start_s), Rigid3(), events_.front().t_ns,
                          events_.back().t_ns);
    // A place beyond the last column of a panorama that wraps is at its border, not lost.
    ImageF image(panorama_.width, panorama_.height);
    for (const Event& event : events_) {
      const auto place = places_.find(event.x, event.y, poses.at(event.t_ns));
      if (place && is_inside(image, place->x, place->y)) splat(image, place->x, place->y, 1.0F);
    }
    double sum = 0;
    for (const float count : image.pixels())
      sum += static_cast<double>(count) * static_cast<double>(count);
    return sum;
  }

 private:
  std::span<const Event> events_;
  const Trajectory& poses_;
  Panorama panorama_;
  DirectionFinder places_;
};

/// Parabolas along the three axes, in steps that shrink where they lead nowhere.
Eigen::Vector3d climb(const Sharpness& sharpness, Eigen::Vector3d rate, double step, double most) {
  constexpr int kMostTurns = 40;
  const double least = step / 16;
  double here = sharpness(rate);
  for (int turn = 0; turn < kMostTurns && step > least; ++turn) {
    std::array<Eigen::Vector3d, 6> steps;
    for (std::size_t k = 0; k < steps.size(); ++k) {
      const auto axis = static_cast<int>(k / 2);
      const double to = rate[axis] + (k % 2 == 0 ? step : -step);
      steps[k] = (std::clamp(to, -most, most) - rate[axis]) * Eigen::Vector3d::Unit(axis);
    }
    std::array<double, 6> beside{};
    parallel_for(beside.size(), [&](std::size_t k) { beside[k] = sharpness(rate + steps[k]); });
    Eigen::Vector3d move;
    for (int axis = 0; axis < 3; ++axis) {
      const double up = beside[static_cast<std::size_t>(2 * axis)];
      const double down = beside[static_cast<std::size_t>(2 * axis + 1)];
      const double curvature = up + down - 2 * here;
      const double top = curvature < 0 ? (down - up) / (2 * curvature) : (up > down ? 2.0 : -2.0);
      const double to = rate[axis] + step * std::clamp(top, -2.0, 2.0);
      move[axis] = std::clamp(to, -most, most) - rate[axis];
    }
    const double there = sharpness(rate + move);
    const auto best = std::max_element(beside.begin(), beside.end());
    if (there > std::max(here, *best)) {
      rate += move;
      here = there;
      if (move.norm() < step) step /= 2;
    } else if (*best > here) {
      rate += steps[static_cast<std::size_t>(best - beside.begin())];
      here = *best;
    } else {
      step /= 2;
    }
  }
  return rate;
}

}  // namespace

Trajectory without_rate(const Trajectory& world_from_camera, const Eigen::Vector3d& rate,
                        double start_s) {
  const auto poses = world_from_camera.poses();
  std::vector<StampedPose> result(poses.begin(), poses.end());
  const std::size_t start = world_from_camera.last_before(start_s).value_or(0);
  const auto turned = [&](std::size_t i, std::size_t from) {
    const Eigen::Quaterniond between = poses[from].world_from_camera.rotation().conjugate() *
                                       poses[i].world_from_camera.rotation();
    const double dt_s = poses[i].t_s - poses[from].t_s;
    result[i].world_from_camera =
        Rigid3(result[from].world_from_camera.rotation() * between * so3_exp(-dt_s * rate),
               poses[i].world_from_camera.translation());
  };
  for (std::size_t i = start + 1; i < poses.size(); ++i) turned(i, i - 1);
  for (std::size_t i = start; i-- > 0;) turned(i, i + 1);
  return Trajectory(std::move(result));
}

Eigen::Vector3d sharpest_rate_offset(std::span<const Event> events, const PinholeCamera& camera,
                                     const Trajectory& world_from_camera, double pixels_per_radian,
                                     const RateOffsetOptions& options) {
  const Events some = some_of(events, options.events);
  const double duration_s = std::max(seconds_from_ns(some.back().t_ns - some.front().t_ns), 1e-3);
  const auto turns = turns_of(world_from_camera, events);
  Eigen::Vector3d rate = Eigen::Vector3d::Zero();
  for (int level = options.levels - 1; level >= 0; --level) {
    const Panorama panorama =
        panorama_around(FieldOfView(camera), turns, pixels_per_radian / (1 << level));
    // A pixel in all, by which the first and the last events are apart.
    const double step = 1 / (panorama.pixels_per_radian() * duration_s);
    rate = climb(Sharpness(some, camera, world_from_camera, panorama), rate, step, options.most);
  }
  return rate;
}

}  // namespace saccade
