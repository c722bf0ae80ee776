#pragma once

#include <span>

#include <Eigen/Core>

#include "core/camera.h"
#include "core/event.h"
#include "core/trajectory.h"

namespace saccade {

struct RateOffsetOptions {
  bool estimate = false;
  int events = 100000;  ///< so many of them, evenly taken
  int levels = 3;       ///< the panorama is this often halved at first, less one
  double most = 0.2;    ///< of a component [rad/s]: a panorama that collapses is sharp, too
};

/// The same orientations as of a camera that turns by `rate` [rad/s, in its axes] slower, and as
/// they are at `start_s`.
[[nodiscard]] Trajectory without_rate(const Trajectory& world_from_camera,
                                      const Eigen::Vector3d& rate, double start_s);

/// What a gyroscope's bias leaves in orientations: the constant rate [rad/s, in the camera's axes]
/// without which all events, as places of a panorama, fall together most sharply,
///   max over b of  sum_x H(x; b)^2,   H the image of events in the panorama of without_rate(b)
/// (contrast maximisation; Gallego, Rebecq and Scaramuzza, CVPR 2018), from coarse panoramas to the
/// one of `pixels_per_radian`. `events` lie within the time of the orientations, at least one.
[[nodiscard]] Eigen::Vector3d sharpest_rate_offset(std::span<const Event> events,
                                                   const PinholeCamera& camera,
                                                   const Trajectory& world_from_camera,
                                                   double pixels_per_radian,
                                                   const RateOffsetOptions& options);

}  // namespace saccade
