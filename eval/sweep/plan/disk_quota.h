#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "eval/sweep/plan/plan.h"

namespace saccade {

/// Makes generated datasets as far as they fit into a given space: some at first, then in rounds as
/// many as still fit by the mean of those that are there. Datasets that do not fit are held
/// (JobState::kHeld). What else the disk holds does not count.
class DiskQuota {
 public:
  /// Holds all datasets but the first.
  DiskQuota(double disk_gb, std::vector<SweepJob>& simulations);

  /// Releases the next datasets. False where none is left or fits.
  bool release_next();

  /// What is left out; empty: nothing.
  [[nodiscard]] std::string message() const;

 private:
  double disk_gb_;
  std::vector<SweepJob>& simulations_;
  std::size_t released_ = 0;
  std::uintmax_t used_ = 0;  ///< bytes of the datasets that are there
};

/// Bytes of all regular files below a folder.
[[nodiscard]] std::uintmax_t bytes_below(const std::filesystem::path& folder);

}  // namespace saccade
