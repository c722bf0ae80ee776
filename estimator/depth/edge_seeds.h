#pragma once

#include <vector>

#include <Eigen/Core>

#include "core/camera.h"
#include "estimator/depth/depth_estimator.h"
#include "estimator/depth/event_rays.h"

namespace saccade {

/// A plane of the sweep and the part of the window that votes on it.
struct SweepPlane {
  float inverse_depth = 0;
  float step = 0;                     ///< to the next plane [1/m]
  float motion_px = 0;                ///< of a point on it over that part, at most
  int first_slab = 0, last_slab = 0;  ///< [first, last)
};

/// A place in the reference view where an edge may be.
struct EdgeSeed {
  Eigen::Vector2f pixel;   ///< on the edge
  Eigen::Vector2f normal;  ///< unit, towards the brighter side
  float inverse_depth = 0;
  float score = 0;        ///< votes per pixel of the ridge
  float strength = 1;     ///< of the ridge, over the least that makes a seed
  float share = 1;        ///< of the votes of the best plane at its pixel
  float parallax_px = 0;  ///< deviation over the window, across the edge
  SweepPlane plane;       ///< where it was found
};

struct SeedOptions {
  enum class Votes { kVector, kCount };

  double motion_px = 30;   ///< of a point over the part of the window that votes on its depth
  double spacing_px = 5;   ///< parallax between neighbouring planes over that part
  double blur_px = 0.8;    ///< of the votes, sigma of the Gaussian
  double min_votes = 1.5;  ///< of a ridge, per pixel after the blur
  double min_density =
      0.05;                ///< the same, per pixel of motion: a blob that did not move is no line
  double min_share = 0.8;  ///< a plane's ridge needs this share of the best plane's votes there
  double min_alignment =
      0.1;  ///< |cos| between an edge's normal and the motion of the rays over it
  double min_parallax_px = 0.3;  ///< deviation over the window, across the edge
  Votes votes = Votes::kVector;
};

/// The planes of the sweep, from far to near. On each votes the part of the window around the
/// reference time over which its points move by `motion_px`: the nearer, the shorter. So the planes
/// get farther apart as they come nearer (a constant ratio), and a point is seen equally well at
/// every depth.
[[nodiscard]] std::vector<SweepPlane> sweep_planes(const EventRays& rays,
                                                   const PinholeCamera& camera,
                                                   const DepthLimits& limits,
                                                   const SeedOptions& options);

/// Where edges may be, by a space sweep. The ray of every event votes, at the pixel where it meets
/// the plane, with the unit vector p x'(rho) / |x'(rho)| along which the log intensity rises. At an
/// edge's depth its votes agree and gather on a line; elsewhere they spread, and those of different
/// edges cancel. Seeds are the pixels on a ridge of |votes| in the plane (its normal is that of the
/// ridge) with more votes than in the two planes beside it. Several planes may give a seed at the
/// same pixel. (The voting follows EMVS, which is covered by patent WO2018/037079.)
[[nodiscard]] std::vector<EdgeSeed> find_seeds(const EventRays& rays, const PinholeCamera& camera,
                                               const DepthLimits& limits,
                                               const SeedOptions& options);

}  // namespace saccade
