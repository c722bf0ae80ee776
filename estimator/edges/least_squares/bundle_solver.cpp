#include "estimator/edges/least_squares/bundle_solver.h"

#include <optional>
#include <utility>

#include "core/stopwatch.h"
#include "estimator/edges/least_squares/bundle_equations.h"
#include "estimator/edges/least_squares/bundle_rows.h"
#include "estimator/edges/least_squares/ceres_bundle.h"
#include "estimator/edges/least_squares/trust_region.h"

namespace saccade {
namespace {

template <int kSupport, int kUnknowns>
SolverSummary solve_structured(EdgeBundle<kSupport, kUnknowns>& bundle,
                               const BundleSolverOptions& options) {
  // Those of Ceres; and what it calls a step into which a residual or the system has no value.
  constexpr double kGradientTolerance = 1e-10, kStepTolerance = 1e-8;
  constexpr int kMaxInvalidSteps = 5;
  SolverSummary summary;
  const Stopwatch stopwatch;
  BundleRows<kSupport, kUnknowns> rows(bundle);
  auto now = rows.point();
  std::optional<double> cost = rows.cost_at(now);
  if (!cost) return summary;
  summary.is_usable = true;
  summary.iterations.push_back({*cost, stopwatch.seconds()});
  rows.linearise(now);
  BundleEquations<kSupport, kUnknowns> equations(rows);
  TrustRegion region;
  int invalid = 0;
  for (int i = 0; i < options.iterations && !region.is_exhausted(); ++i) {
    equations.build(now, [&](double diagonal) { return region.damping(diagonal); });
    if (equations.greatest_slope() <= kGradientTolerance) break;
    auto trial = now;
    const std::optional<double> predicted = equations.take_step(trial);
    const bool is_valid = predicted && *predicted > 0;
    invalid = is_valid ? 0 : invalid + 1;
    if (invalid == kMaxInvalidSteps) return {std::move(summary.iterations), false};
    if (is_valid && equations.step_norm() <= kStepTolerance * (now.norm() + kStepTolerance)) break;
    const std::optional<double> after = is_valid ? rows.cost_at(trial) : std::nullopt;
    const double decrease = after ? *cost - *after : 0;
    const bool is_better = after && decrease > TrustRegion::kMinRelativeDecrease * *predicted;
    const bool has_converged = is_better && decrease <= options.tolerance * *cost;
    if (is_better) {
      region.accept(decrease / *predicted);
      now = std::move(trial);
      cost = after;
      rows.linearise(now);
    } else {
      region.reject();
    }
    summary.iterations.push_back({*cost, stopwatch.seconds()});
    if (options.each) options.each();
    if (has_converged) break;
  }
  rows.write(now);
  return summary;
}

}  // namespace

template <int kSupport, int kUnknowns>
SolverSummary solve_bundle(EdgeBundle<kSupport, kUnknowns>& bundle, BundleSolver solver,
                           const BundleSolverOptions& options) {
  return solver == BundleSolver::kCeres ? solve_bundle_by_ceres(bundle, options)
                                        : solve_structured(bundle, options);
}

template <int kSupport, int kUnknowns>
PathCovariances<kSupport> path_covariances(EdgeBundle<kSupport, kUnknowns>& bundle) {
  BundleRows<kSupport, kUnknowns> rows(bundle);
  const auto point = rows.point();
  if (!rows.cost_at(point)) return {};
  rows.linearise(point);
  BundleEquations<kSupport, kUnknowns> equations(rows);
  equations.build(point, [](double) { return 0.0; });
  const auto blocks = equations.path_covariances();
  for (const Eigen::MatrixXd& block : blocks)
    if (!block.allFinite()) return {};
  return {blocks.begin(), blocks.end()};
}

template <int kSupport, int kUnknowns>
std::optional<PathInformation> path_information(EdgeBundle<kSupport, kUnknowns>& bundle,
                                                std::size_t first, std::size_t last) {
  BundleRows<kSupport, kUnknowns> rows(bundle);
  const auto point = rows.point();
  rows.linearise_edges(point, first, last);
  const PathInformation found =
      BundleEquations<kSupport, kUnknowns>(rows, first, last).path_information(point);
  if (!found.information.allFinite() || !found.gradient.allFinite()) return std::nullopt;
  return found;
}

template SolverSummary solve_bundle(WindowBundle&, BundleSolver, const BundleSolverOptions&);
template SolverSummary solve_bundle(PathBundle&, BundleSolver, const BundleSolverOptions&);
template PathCovariances<2> path_covariances(WindowBundle&);
template PathCovariances<4> path_covariances(PathBundle&);
template std::optional<PathInformation> path_information(WindowBundle&, std::size_t, std::size_t);
template std::optional<PathInformation> path_information(PathBundle&, std::size_t, std::size_t);

}  // namespace saccade
