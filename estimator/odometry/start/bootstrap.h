#pragma once

#include <cstddef>
#include <span>

#include "core/camera.h"
#include "core/event.h"
#include "core/trajectory.h"
#include "estimator/odometry/start/path_refinement.h"

namespace saccade {

/// Where there is no start, or one that fails its trial, the next is looked for so much later.
inline constexpr double kStartRetry_s = 0.1;
/// Each time that the camera moved and there still was none, the longer: the search of a long
/// recording without a start takes a time that grows with the logarithm of its length.
inline constexpr double kStartRetryGrowth = 1.2;

struct BootstrapOptions {
  double depth_m = 1;          ///< the scale is free: the typical depth is called so
  double window_s = 0.25;      ///< of the path that is found, at most
  double max_search_s = 0.25;  ///< longest window of the first search, PlaneSearch
  PathRefinementOptions refinement = start_refinement();
  double growth = 1.15;  ///< of its window, from round to round
};

/// A start without any pose given.
struct Bootstrap {
  enum class Status {
    kFound,
    kNoMotion,     ///< nothing but noise in all of the events
    kUnexplained,  ///< they show a motion, but no path that was tried explains enough of them
  };
  Status status = Status::kNoMotion;
  Trajectory path;         ///< world_from_camera, the identity at its first pose
  std::size_t edges = 0;   ///< found with it
  double residual_px = 0;  ///< robust standard deviation of their events
  double parallax_px = 0;  ///< of the typical depth, at the largest distance from the first pose
};

/// Finds how the camera moved at first, from events alone and up to scale: motions before a plane
/// by contrast (PlaneSearch), the likely directions of motion by the flow of tiles (fit_motion), then
/// for each of them path and edges adjusted together (PathRefinement); of the paths that explain about
/// as many events as the best the one of least parallax. With a gyroscope the flow is not needed: of the
/// plane's motions the path by which most events lie on edges is taken. The path is extrapolated by
/// little at a time: the longer it is, the better it distinguishes rotation from translation, but no hand
/// keeps its velocity for long. Where no trial (start_trial.h) follows, the flow must tell the direction.
/// A camera that only rotates starts, too, at hardly any parallax; with a gyroscope it does not. Where it
/// rests, the start begins later. `events` in order of time; `camera` with its lens; `gyroscope`, where it
/// is not empty, measures the rotation. Deterministic.
[[nodiscard]] Bootstrap find_start(std::span<const Event> events, const PinholeCamera& camera,
                                   const BootstrapOptions& options,
                                   const Gyroscope& gyroscope = {});

}  // namespace saccade
