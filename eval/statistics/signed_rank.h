#pragma once

#include <cstddef>
#include <span>

namespace saccade {

/// Wilcoxon's signed-rank test of paired differences (Wilcoxon, Biometrics 1(6), 1945).
struct SignedRank {
  std::size_t pairs = 0;  ///< that differ; equal ones say nothing of the direction
  /// Matched-pairs rank-biserial correlation (Kerby 2014), (W+ - W-) / (W+ + W-) in [-1, 1], with W+
  /// and W- the sums of the ranks of positive and negative differences: 1 where all are positive.
  /// 0 without pairs.
  double effect = 0;
  double p = 1;  ///< two-sided, of differences without a preferred sign
};

/// Equal absolute values share the mean of their ranks. Exact up to 50 pairs, by counting the sign
/// patterns; of more the normal approximation with the correction for ties. With n pairs p cannot
/// fall below 2^(1 - n): below 0.05 from six on.
[[nodiscard]] SignedRank signed_rank_test(std::span<const double> differences);

}  // namespace saccade
