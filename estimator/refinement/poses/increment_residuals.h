#pragma once

#include <optional>
#include <vector>

#include "estimator/refinement/poses/increment_cost.h"
#include "estimator/refinement/poses/increment_images.h"
#include "estimator/refinement/poses/path_problem.h"
#include "estimator/refinement/poses/pose_refinement.h"
#include "estimator/refinement/poses/visible_surface.h"

namespace saccade {

/// Residuals of brightness-increment images (increment_cost.h). An increment is known to within a
/// threshold: what a pixel went on by after its last event is open at both ends of the window,
/// which makes a triangle of variance C^2 / 6.
class IncrementResiduals {
 public:
  /// `contrast`: C [log units]. `surface` and `images` outlive this.
  IncrementResiduals(const MapSurface& surface, const IncrementImages& images, double contrast,
                     const PoseRefinementOptions& options)
      : surface_(surface), images_(images), contrast_(contrast), options_(options) {}

  /// Those of the points visible from the problem's path, and a weak prior of its control poses.
  void add_to(PathProblem& problem) const;

 private:
  /// The map at a pixel at an end of a window.
  struct Seen {
    MapSurface::Hit hit;
    Eigen::Vector2d slope;  ///< of the map [log units/px]
  };
  using Row = std::vector<std::optional<Seen>>;  ///< as the images' pixels
  [[nodiscard]] Row sample(VisibleSurface& surfaces, double t_s) const;
  [[nodiscard]] double sigma(const Seen& begin, const Seen& end) const;

  const MapSurface& surface_;
  const IncrementImages& images_;
  double contrast_;
  const PoseRefinementOptions& options_;
};

}  // namespace saccade
