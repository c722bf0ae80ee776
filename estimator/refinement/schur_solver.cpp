#include "estimator/refinement/schur_solver.h"

namespace saccade {

ceres::Solver::Summary solve_by_schur(
    ceres::Problem& problem, const std::shared_ptr<ceres::ParameterBlockOrdering>& ordering,
    int iterations, double tolerance) {
  ceres::Solver::Options options;
  options.linear_solver_type = ceres::DENSE_SCHUR;
  options.linear_solver_ordering = ordering;
  options.max_num_iterations = iterations;
  options.function_tolerance = tolerance;
  options.num_threads = 1;
  options.logging_type = ceres::SILENT;
  ceres::Solver::Summary summary;
  ceres::Solve(options, &problem, &summary);
  return summary;
}

}  // namespace saccade
