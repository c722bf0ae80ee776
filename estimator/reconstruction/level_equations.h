#pragma once

#include <span>

#include "core/event.h"
#include "core/trajectory.h"
#include "estimator/reconstruction/image_estimator.h"
#include "estimator/reconstruction/place_levels.h"
#include "estimator/reconstruction/reference_grid.h"

namespace saccade {

struct EquationOptions {
  LevelOptions levels;
  int scale = 1;          ///< unknowns per pixel and direction
  double thin_px = 0;     ///< levels of a pixel whose places are this near are joined; 0: never
  double smoothness = 2;  ///< deviation of the difference of neighbours that nothing is known of
  double knee = 0.02;     ///< difference from which on only its size counts, not its square
  double across = 20;     ///< the same across the edge of an occluder [log units]
  int rounds = 2;         ///< the second and later ones with robust weights
  double outlier = 3;     ///< deviations beyond which an equation counts less
  double bound_sigma = 0.05;     ///< of a silent pixel's bounds, from the second round on [log]
  int iterations = 60;           ///< of conjugate gradients, per round
  double tolerance = 1e-3;       ///< of their residual, where they end earlier
  double prior_sigma = 0.5;      ///< of a gradient's component, for its covariance [log units/px]
  double observed_sigma = 0.25;  ///< a pixel is observed when its surest direction is this sure
};

/// Every event is one linear equation of the reference view's log intensity: at the instant of its
/// k-th event a pixel knows the level at the place it looks at exactly, but for an offset of its
/// own,
///   L(place at t_k) = c_pixel + sum_(i <= k) p_i C,
/// the left side bilinear between pixels. All together, with a weak smoothness where nothing is
/// known, are a sparse linear least-squares problem for image and offsets; no gradient is
/// linearised and none integrated. `view`: the pixels whose image it is, of the size that `finder`
/// finds places in; `grid`: the unknowns.
[[nodiscard]] Reconstruction solve_equations(LevelFinder& finder, std::span<const Event> events,
                                             const Trajectory& world_from_camera,
                                             const ReferenceGrid& view, const ReferenceGrid& grid,
                                             const EquationOptions& options,
                                             const ShareDone& done = {});

}  // namespace saccade
