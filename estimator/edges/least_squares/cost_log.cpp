#include "estimator/edges/least_squares/cost_log.h"

#include <ceres/iteration_callback.h>

#include "core/io/tables/csv_file.h"

namespace saccade {

void CostLog::add_round(std::span<const ceres::IterationSummary> iterations, double start_s) {
  for (const ceres::IterationSummary& iteration : iterations)
    steps_.push_back({rounds_, iteration.iteration, iteration.cost,
                      start_s + iteration.cumulative_time_in_seconds});
  ++rounds_;
}

void CostLog::save(const std::filesystem::path& file) const {
  CsvTable table({"round", "iteration", "cost", "seconds"});
  for (const IterationCost& step : steps_)
    table.add({static_cast<long long>(step.round), static_cast<long long>(step.iteration),
               step.cost, step.seconds});
  table.save(file);
}

}  // namespace saccade
