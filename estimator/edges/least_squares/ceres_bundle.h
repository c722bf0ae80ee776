#pragma once

#include "estimator/edges/least_squares/cost_log.h"
#include "estimator/edges/least_squares/edge_bundle.h"

namespace saccade {

/// Solves a bundle by Ceres: the reference for solve_bundle(), to the same costs. By
/// Levenberg-Marquardt with the edges eliminated first, a dense reduced system, and one thread.
template <int kSupport, int kUnknowns>
[[nodiscard]] SolverSummary solve_bundle_by_ceres(EdgeBundle<kSupport, kUnknowns>& bundle,
                                                  const BundleSolverOptions& options);

}  // namespace saccade
