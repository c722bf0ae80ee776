#pragma once

#include <vector>

#include "estimator/refinement/poses/log_intensity_chains.h"
#include "estimator/refinement/poses/path_problem.h"
#include "estimator/refinement/poses/pose_refinement.h"

namespace saccade {

/// Residuals of single events, exactly what they say (log_intensity_cost.h).
class ChainResiduals {
 public:
  /// `surface` and `levels` outlive this.
  ChainResiduals(const MapSurface& surface, const LogIntensityChains& levels,
                 const PoseRefinementOptions& options)
      : surface_(surface), levels_(levels), options_(options) {}

  /// Those of the points visible from the problem's path, and a weak prior of its control poses. This
  /// outlives the problem's solution.
  void add_to(PathProblem& problem);

 private:
  /// An observation with what it saw of the map.
  struct Seen {
    const ChainObservation* observation;
    MapSurface::Hit hit;
    double level;  ///< that the map shows
    double sigma;
  };
  void find_surfaces(const SplineControls& path);
  void start_offsets();
  void add_event(const Seen& seen, PathProblem& problem);

  const MapSurface& surface_;
  const LogIntensityChains& levels_;
  const PoseRefinementOptions& options_;
  std::vector<double> offsets_;
  std::vector<int> length_;  ///< of a chain as far as it is seen
  std::vector<Seen> seen_;
};

}  // namespace saccade
