#pragma once

#include <vector>

#include "estimator/refinement/poses/event_run_observations.h"
#include "estimator/refinement/poses/path_problem.h"
#include "estimator/refinement/poses/pose_refinement.h"

namespace saccade {

/// Residuals of single events, exactly what they say (log_intensity_cost.h).
class EventRunResiduals {
 public:
  /// `surface` and `observed` outlive this.
  EventRunResiduals(const MapSurface& surface, const EventRunObservations& observed,
                    const PoseRefinementOptions& options)
      : surface_(surface), observed_(observed), options_(options) {}

  /// Those of the points visible from the problem's path, and a weak prior of its control poses. This
  /// outlives the problem's solution.
  void add_to(PathProblem& problem);

 private:
  /// An observation with what it saw of the map.
  struct Seen {
    const EventRunObservation* observation;
    MapSurface::Hit hit;
    double map_log_intensity;
    double sigma;
  };
  void find_surfaces(const SplineControls& path);
  void start_offsets();
  void add_event(const Seen& seen, PathProblem& problem);

  const MapSurface& surface_;
  const EventRunObservations& observed_;
  const PoseRefinementOptions& options_;
  std::vector<double> offsets_;
  std::vector<int> length_;  ///< of a run as far as it is seen
  std::vector<Seen> seen_;
};

}  // namespace saccade
