#include "estimator/edges/least_squares/schur_solver.h"

namespace saccade {
namespace {

class CallEach : public ceres::IterationCallback {
 public:
  explicit CallEach(const std::function<void()>& each) : each_(each) {}
  ceres::CallbackReturnType operator()(const ceres::IterationSummary&) override {
    each_();
    return ceres::SOLVER_CONTINUE;
  }

 private:
  const std::function<void()>& each_;
};

SolverSummary solve(ceres::Problem& problem, ceres::Solver::Options options, int iterations,
                    double tolerance) {
  options.max_num_iterations = iterations;
  options.function_tolerance = tolerance;
  options.num_threads = 1;
  options.logging_type = ceres::SILENT;
  ceres::Solver::Summary solved;
  ceres::Solve(options, &problem, &solved);
  SolverSummary summary;
  summary.is_usable = solved.IsSolutionUsable();
  for (const ceres::IterationSummary& iteration : solved.iterations)
    summary.iterations.push_back({iteration.cost, iteration.cumulative_time_in_seconds});
  return summary;
}

}  // namespace

SolverSummary solve_by_schur(ceres::Problem& problem,
                             const std::shared_ptr<ceres::ParameterBlockOrdering>& ordering,
                             int iterations, double tolerance, const std::function<void()>& each) {
  ceres::Solver::Options options;
  options.linear_solver_type = ceres::DENSE_SCHUR;
  options.linear_solver_ordering = ordering;
  CallEach call_each(each);
  if (each) options.callbacks.push_back(&call_each);
  return solve(problem, options, iterations, tolerance);
}

SolverSummary solve_sparsely(ceres::Problem& problem, int iterations, double tolerance) {
  ceres::Solver::Options options;
  options.linear_solver_type = ceres::SPARSE_NORMAL_CHOLESKY;
  return solve(problem, options, iterations, tolerance);
}

}  // namespace saccade
