#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace saccade {

/// Values of a metric over commits (rows, in order of time) and repetitions (columns: seeds, which
/// are paired over the commits); nullopt where there is no run.
using CommitValues = std::vector<std::vector<std::optional<double>>>;

/// A commit from which on the values have another level.
struct ChangePoint {
  std::size_t at = 0;  ///< index of the first commit of the new level
  double before = 0;   ///< mean over the commits of the level before
  double after = 0;
  double p = 1;  ///< of the permutation test
};

struct ChangeOptions {
  double alpha = 0.01;              ///< of one search; in (0, 1)
  double least_difference = 0;      ///< between the levels, absolute; smaller ones do not count
  std::size_t permutations = 1999;  ///< >= 99
  std::uint64_t seed = 1;
};

/// Binary segmentation: the split with the largest standardised difference of means
///   |m_right - m_left| sqrt(n_left n_right / (n_left + n_right))
/// of the values less the mean of their seed counts where at most `alpha` of random permutations,
/// within each seed over the commits, have a split that differs as much; then both sides are
/// searched. Equal input gives an equal result. In order of the commits.
[[nodiscard]] std::vector<ChangePoint> change_points(const CommitValues& values,
                                                     const ChangeOptions& options = {});

}  // namespace saccade
