#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include <Eigen/Core>

#include "estimator/edges/least_squares/cost_log.h"
#include "estimator/edges/least_squares/edge_bundle.h"
#include "estimator/edges/least_squares/path_information.h"

namespace saccade {

/// Solves a bundle by one of the solvers. kCeres is solve_bundle_by_ceres(). kStructured is
/// Levenberg-Marquardt (the damping, the trust region and the criteria of Ceres,
/// so that costs compare), with every edge eliminated by hand: its block of the normal equations is
/// kUnknowns wide, and what is left of it is a product of dense matrices for some edges at a time
/// (ReducedSystem). Residuals and derivatives are computed for kEventLanes events at once. Time and
/// memory grow with the events and with the kept unknowns that an edge couples. Deterministic for
/// any number of threads. Steps into which a residual cannot be evaluated are not taken.
template <int kSupport, int kUnknowns>
[[nodiscard]] SolverSummary solve_bundle(EdgeBundle<kSupport, kUnknowns>& bundle,
                                         BundleSolver solver, const BundleSolverOptions& options);

/// Of kSupport neighbouring twists of a path, from each twist on.
template <int kSupport>
using PathCovariances = std::vector<Eigen::Matrix<double, 6 * kSupport, 6 * kSupport>>;

/// The covariance of every `kSupport` neighbouring twists of the path, whatever the edges are: block
/// i is of the twists i .. i + kSupport - 1,
///   block of (J_k^T J_k - sum over edges of J_k^T J_e (J_e^T J_e)^-1 J_e^T J_k)^-1,
/// J with the weights of the losses. Empty where the problem does not determine it.
template <int kSupport, int kUnknowns>
[[nodiscard]] PathCovariances<kSupport> path_covariances(EdgeBundle<kSupport, kUnknowns>& bundle);

/// Of the edges first .. last - 1, from where the unknowns are now. nullopt where it has no value.
template <int kSupport, int kUnknowns>
[[nodiscard]] std::optional<PathInformation> path_information(
    EdgeBundle<kSupport, kUnknowns>& bundle, std::size_t first, std::size_t last);

}  // namespace saccade
