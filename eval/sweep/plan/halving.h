#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "eval/sweep/plan/halving_config.h"
#include "eval/sweep/plan/plan.h"

namespace saccade {

/// A row of the sweep that was stopped.
struct StoppedRow {
  SweepPoint point;       ///< its configuration, variant and grid point
  std::size_t rank = 0;   ///< from 1 on, among the rows that were left
  std::size_t rows = 0;   ///< that were left
  std::size_t pairs = 0;  ///< of dataset and seed that they had been run over
};

/// Lets the runs of a sweep go on in rounds: all rows over the first pairs of dataset and seed, then
/// the better of them over twice as many, until those that are left have run over all. Pairs come
/// from all datasets in turn. A row's rank is the mean over the pairs of its rank in each, where a
/// run that came to nothing, or has no value, is the last. Decisions depend on the results alone, so
/// that an interrupted sweep goes on to the same end.
class Halving {
 public:
  /// Holds all runs but those of the first round (JobState::kHeld). The row `reference`, a variant
  /// or configuration, is never stopped; empty: none.
  Halving(const HalvingConfig& config, std::string reference, std::vector<SweepJob>& runs);

  /// Stops rows by the results of all rounds so far and releases the next one. False where none is
  /// left.
  bool release_next();

  [[nodiscard]] const std::vector<StoppedRow>& stopped() const { return stopped_; }

 private:
  struct Row {
    SweepPoint point;
    std::vector<std::size_t> runs;  ///< by pair; kNone where it has none
    bool is_left = true;
  };

  void stop_rows();
  [[nodiscard]] std::vector<double> mean_ranks(const std::vector<const Row*>& rows) const;

  HalvingConfig config_;
  std::string reference_;
  std::vector<SweepJob>& runs_;
  std::vector<Row> rows_;
  std::size_t pairs_ = 0;     ///< in all
  std::size_t released_ = 0;  ///< of these
  std::vector<StoppedRow> stopped_;
};

}  // namespace saccade
