#pragma once

#include <vector>

#include <Eigen/Core>

namespace ceres {
class Problem;
}

namespace saccade {

/// What a problem's residuals, with their losses, say of the blocks `kept` when those `eliminated`
/// may be anything: the Schur complement of J^T J,
///   I = J_k^T J_k - sum over e of J_k^T J_e (J_e^T J_e)^-1 J_e^T J_k,
/// with the kept blocks' unknowns in their order. All eliminated blocks have the same size and no
/// residual has two of them; one that nothing constrains is left out. Empty where a residual cannot
/// be evaluated.
[[nodiscard]] Eigen::MatrixXd marginal_information(ceres::Problem& problem,
                                                   const std::vector<double*>& kept,
                                                   const std::vector<double*>& eliminated);

}  // namespace saccade
