#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "core/camera.h"
#include "core/event.h"
#include "core/trajectory.h"

namespace saccade {

/// Orientations at the first event, at the last one and every ms in between; at least one event.
[[nodiscard]] std::vector<Eigen::Matrix3d> orientations_of(const Trajectory& world_from_camera,
                                                           std::span<const Event> events);

/// The same orientations for an angular velocity that is smaller by `rate` [rad/s, camera axes], and
/// unchanged at `start_s`.
[[nodiscard]] Trajectory without_rate(const Trajectory& world_from_camera,
                                      const Eigen::Vector3d& rate, double start_s);

/// The error that a gyroscope's bias leaves in orientations: the constant rate [rad/s, camera axes]
/// that maximises the contrast of all events in a panorama,
///   max over b of  sum_x H(x; b)^2,   H the image of events in the panorama of without_rate(b)
/// (Gallego, Rebecq and Scaramuzza, CVPR 2018), from coarse panoramas to the one of
/// `pixels_per_radian`. `events` lie within the time of the orientations, at least one; a sample of
/// `max_events` >= 1 of them is used, evenly taken, of half and a quarter as many in the coarser panoramas.
[[nodiscard]] Eigen::Vector3d sharpest_rate_offset(std::span<const Event> events,
                                                   const PinholeCamera& camera,
                                                   const Trajectory& world_from_camera,
                                                   double pixels_per_radian,
                                                   std::size_t max_events = 100000);

}  // namespace saccade
