#include "estimator/edges/least_squares/cost_log.h"

#include "core/io/tables/csv_file.h"

namespace saccade {

void CostLog::add_round(std::span<const SolverIteration> iterations, double start_s) {
  for (std::size_t i = 0; i < iterations.size(); ++i)
    steps_.push_back(
        {rounds_, static_cast<int>(i), iterations[i].cost, start_s + iterations[i].seconds});
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
