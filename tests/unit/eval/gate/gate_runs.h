#pragma once

#include <cmath>
#include <string>
#include <vector>

#include "core/random.h"
#include "eval/gate/comparison.h"

namespace saccade::testing {

/// Scored runs of a tracker as they scatter: two sequences, `seeds` each, the mean errors with a
/// deviation of 3 % from seed to seed, as measured with the setting `accurate`.
struct FakeScores {
  std::uint64_t build = 0;  ///< whose draws; another build draws its samples in another order
  std::size_t seeds = 15;
  double scatter = 0.03;
  double time_scatter = 0.02;

  [[nodiscard]] std::vector<GateRun> runs() const {
    const Random random(11 + build);
    std::vector<GateRun> runs;
    for (const char* dataset : {"walls", "planes"})
      for (std::size_t seed = 0; seed < seeds; ++seed) {
        const std::uint64_t stream = runs.size();
        const auto about = [&](double value, double sigma, std::uint64_t index) {
          return value * std::exp(sigma * random.normal(stream, index));
        };
        GateRun run;
        run.key = {dataset, "track", "accurate", seed};
        run.machine = "a processor, Linux";
        run.threads = 1;
        run.tool_version = "0.1.0 (test)";
        const double wall_s = about(0.14, time_scatter, 4);
        run.metrics = {{"trajectory.dt_rel_percent.mean", about(0.17, scatter, 0)},
                       {"trajectory.dtheta_deg.mean", about(0.09, scatter, 1)},
                       {"trajectory.none.ate_rmse_m", about(0.013, scatter, 2)},
                       {"trajectory.reprojection_px.rms", about(0.18, scatter, 3)},
                       {"trajectory.coverage", 0.998},
                       {"trajectory.lost_s", 0.0},
                       {"trajectory.nees", std::nullopt},
                       {"reconstruction.fit.scale", 0.9},
                       {"speed.wall_s.median", wall_s},
                       {"speed.wall_s.min", 0.98 * wall_s},
                       {"speed.wall_s.max", 1.02 * wall_s},
                       {"speed.repetitions", 20.0},
                       {"speed.events", 1742392.0}};
        runs.push_back(std::move(run));
      }
    return runs;
  }
};

/// Multiplies a metric of all runs of a dataset, or with "" of all.
inline void scale(std::vector<GateRun>& runs, const std::string& metric, double factor,
                  const std::string& dataset = "") {
  for (GateRun& run : runs)
    if (dataset.empty() || run.key.dataset == dataset) *run.metrics.at(metric) *= factor;
}

/// The options of the tests: fewer resamples, for speed.
inline GateOptions quick_gate() {
  GateOptions options;
  options.resamples = 1000;
  return options;
}

}  // namespace saccade::testing
