#pragma once

#include <cstddef>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

#include "core/camera.h"
#include "estimator/depth/depth_estimator.h"
#include "estimator/depth/rays/edgel_index.h"
#include "estimator/depth/rays/edgel_seeds.h"
#include "estimator/depth/rays/event_assignment.h"
#include "estimator/depth/rays/event_rays.h"
#include "estimator/depth/rays/gate_counts.h"
#include "estimator/depth/rays/ray_gatherer.h"
#include "estimator/depth/rays/ray_regression.h"

namespace saccade {

struct RefinerOptions {
  RegressionOptions regression;
  double spacing_px = 1.4;
  double max_sigma = 0.02;
  /// Whether regressions over the whole window go on until they have converged. What they leave else
  /// is a tenth of a standard deviation, the same for neighbours, so that no fusion takes it out.
  bool until_converged = false;
  /// Of an inverse depth around that of the stage before [1/m].
  double prior_sigma = std::numeric_limits<double>::infinity();
};

/// Uncertainty of an inverse depth that is predicted from the neighbours.
struct NeighbourPrediction {
  float sigma = 0;      ///< of the prediction [1/m]
  float gap = 0;        ///< to the nearest other surface around [1/m]
  float max_sigma = 0;  ///< the sigma of a confirmed edgel is not stated larger than this [1/m]
};

/// Refines seeds to edgels by regressions over increasing parts of the window, one seed after the
/// other: later seeds of an edgel that was found already are skipped.
class EdgelRefiner {
 public:
  /// Edgels at one pixel whose inverse depths differ by less, relatively, are one.
  static constexpr float kSameEdgelDepth = 0.01F;

  /// `rays` and `options` outlive it.
  EdgelRefiner(const EventRays& rays, const RefinerOptions& options, const DepthLimits& limits,
               const PinholeCamera& camera);

  /// From the part of the window that voted for the seed to the whole, each stage as long as the
  /// accuracy of the depth so far allows. Appends the edgel's events to `events`; nullopt without
  /// one.
  [[nodiscard]] std::optional<FittedEdgel> refine(const EdgelSeed& seed, EdgelEvents& events);

  /// An edgel whose inverse depth is predicted by its neighbours, edge.inverse_depth; over the whole
  /// window. Its own events must be consistent with it, and separate it from other surfaces nearby.
  [[nodiscard]] std::optional<FittedEdgel> confirm(const Edgel& edge,
                                                   const NeighbourPrediction& prediction,
                                                   EdgelEvents& events);

  /// An edgel of a seed whose depth its events do not tell, by the part of the window that voted for
  /// it: the seed's inverse depth is assumed to be right within `relative_sigma` of it, and what the
  /// events say is added to that. nullopt where there is an edgel already, at any depth.
  [[nodiscard]] std::optional<FittedEdgel> assume(const EdgelSeed& seed, double relative_sigma,
                                                  EdgelEvents& events);

  /// Whether there is such an edgel already, its inverse depth closer than `tolerance`.
  [[nodiscard]] bool has_similar(const Edgel& edge, float tolerance) const {
    return found_.has_similar(edge, tolerance);
  }
  /// The seeds that refine() dropped.
  [[nodiscard]] const GateCounts& dropped() const { return dropped_; }
  /// Replaces the edgels found so far.
  void restart(EdgelIndex found) { found_ = std::move(found); }

 private:
  [[nodiscard]] bool is_plausible(const Edgel& edge, const Eigen::Vector2f& start) const;
  [[nodiscard]] FittedEdgel accepted(const Edgel& edge, const RegressionResult& result,
                                     EdgelEvents& events);
  [[nodiscard]] float unobserved_px(const EdgelEvents& events, std::size_t first);

  const EventRays& rays_;
  const RefinerOptions& options_;
  RegressionOptions last_;  ///< of regressions over the whole window
  DepthLimits limits_;
  PinholeCamera camera_;
  RayGatherer gatherer_;
  EdgelIndex found_;
  RayNeighbourhood near_;
  GateCounts dropped_;
  std::vector<float> observed_;  ///< weight of an edgel's events in each slice
};

}  // namespace saccade
