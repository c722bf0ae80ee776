#pragma once

#include <functional>
#include <memory>

#include <ceres/ceres.h>

#include "estimator/edges/least_squares/cost_log.h"

namespace saccade {

/// Solves by Levenberg-Marquardt with the unknowns of the first group eliminated (dense Schur
/// complement), on one thread: the same result everywhere, as long as the unknowns of a group lie
/// in one array, since within a group Ceres orders by address. Ends after `iterations` or where the
/// cost changes by less than `tolerance`, relative. `each` is called after every iteration.
[[nodiscard]] SolverSummary solve_by_schur(
    ceres::Problem& problem, const std::shared_ptr<ceres::ParameterBlockOrdering>& ordering,
    int iterations, double tolerance, const std::function<void()>& each = {});

/// The same without an order: sparse normal equations, of many residuals over few unknowns.
[[nodiscard]] SolverSummary solve_sparsely(ceres::Problem& problem, int iterations,
                                           double tolerance);

}  // namespace saccade
