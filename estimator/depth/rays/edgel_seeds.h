#pragma once

#include <cstddef>
#include <vector>

#include <Eigen/Core>

#include "core/camera.h"
#include "estimator/depth/depth_estimator.h"
#include "estimator/depth/rays/event_rays.h"

namespace saccade {

/// A plane of the sweep and the part of the window that votes on it.
struct SweepPlane {
  float inverse_depth = 0;
  float spacing = 0;                    ///< to the next plane [1/m]
  float motion_px = 0;                  ///< largest motion of its points over that part
  int first_slice = 0, last_slice = 0;  ///< [first, last)
};

/// A candidate for an edgel.
struct EdgelSeed {
  Eigen::Vector2f pixel;   ///< of the reference view, on the edge
  Eigen::Vector2f normal;  ///< unit, towards the brighter side
  float inverse_depth = 0;
  float score = 0;        ///< votes per pixel of the ridge
  float strength = 1;     ///< score over the least score that makes a seed
  float vote_ratio = 1;   ///< score over the votes of the best plane at its pixel
  float parallax_px = 0;  ///< standard deviation over the window, across the edge
  SweepPlane plane;       ///< on which it was found
};

/// The planes of the sweep, from far to near. On each votes the part of the window around the
/// reference time over which its points move by a given number of pixels: the nearer, the shorter.
/// So the planes are in a constant ratio, and points of all depths get equally many votes.
[[nodiscard]] std::vector<SweepPlane> sweep_planes(const EventRays& rays,
                                                   const PinholeCamera& camera,
                                                   const DepthLimits& limits);

/// What a sweep found.
struct FoundSeeds {
  std::vector<EdgelSeed> seeds;
  std::size_t still = 0;  ///< ridges that moved too little across their edge
};

/// Least standard deviation of a seed's motion across its edge: less tells no depth.
constexpr double kSeedParallax_px = 0.3;

/// Candidates for edgels, by a space sweep. The ray of every event votes, at the pixel where it
/// intersects the plane, with the unit vector p x'(rho) / |x'(rho)| along which the log intensity
/// increases. At an edge's depth its votes agree and lie on a line; elsewhere they spread, and those
/// of different edges cancel. Seeds are the pixels on a ridge of |votes| in the plane (its normal is
/// that of the ridge) with more votes than in the two neighbouring planes. Several planes may give a
/// seed at the same pixel. (The voting follows EMVS, Rebecq et al., IJCV 2018, which is covered by
/// patent WO2018/037079.)
[[nodiscard]] FoundSeeds find_seeds(const EventRays& rays, const PinholeCamera& camera,
                                    const DepthLimits& limits,
                                    double least_parallax_px = kSeedParallax_px);

/// Candidates for edgels whose depth cannot be told: all ridges of |votes| in one plane, whatever
/// their parallax, by the part of the window over which an error of the relative inverse depth of
/// `relative_sigma` moves no point by more than a pixel. Empty where not even one slice of time
/// is that short.
[[nodiscard]] std::vector<EdgelSeed> find_seeds_at(const EventRays& rays,
                                                   const PinholeCamera& camera,
                                                   double inverse_depth, double relative_sigma);

}  // namespace saccade
