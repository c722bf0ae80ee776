#include <benchmark/benchmark.h>

#include <cstddef>
#include <cstdint>

#include "core/process/parallel.h"
#include "estimator/edges/least_squares/bundle_solver.h"
#include "tests/support/synthetic_bundle.h"

namespace saccade {
namespace {

using testing::SyntheticBundle;

/// Ten iterations of a joint adjustment as a batch has it: 3,600 edges of 70 events each. Items are
/// residuals evaluated and eliminated. First argument: threads.
void adjust(benchmark::State& state, BundleSolver solver, std::size_t twists, double seen) {
  set_thread_count(static_cast<int>(state.range(0)));
  SyntheticBundle<4, 5> problem(
      {.twists = twists, .is_robust = false, .edges = 3600, .events = 70, .seen = seen});
  const auto path = problem.path;
  const auto edges = problem.edges;
  for (auto _ : state) {
    problem.path = path;
    problem.edges = edges;
    benchmark::DoNotOptimize(solve_bundle(problem.bundle, solver, {10, 0}));
  }
  state.SetItemsProcessed(state.iterations() * 10 *
                          static_cast<std::int64_t>(problem.bundle.events()));
  set_thread_count(0);
}

void BM_BundleStructured(benchmark::State& state) {
  adjust(state, BundleSolver::kStructured, 40, 1);
}
BENCHMARK(BM_BundleStructured)->Arg(1)->Arg(2)->Unit(benchmark::kMillisecond)->UseRealTime();

/// Edges that are seen again from elsewhere, two stretches of a longer path each, in no order.
void BM_BundleOfParts(benchmark::State& state) {
  adjust(state, BundleSolver::kStructured, 120, 0.3);
}
BENCHMARK(BM_BundleOfParts)->Arg(1)->Arg(2)->Unit(benchmark::kMillisecond)->UseRealTime();

void BM_BundleCeres(benchmark::State& state) { adjust(state, BundleSolver::kCeres, 40, 1); }
BENCHMARK(BM_BundleCeres)->Arg(1)->Unit(benchmark::kMillisecond)->UseRealTime();

}  // namespace
}  // namespace saccade
