#include "eval/statistics/signed_rank.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

namespace saccade {
namespace {

constexpr std::size_t kMostExact = 50;

/// Twice the ranks of the absolute values, in ascending order of these: whole numbers also where
/// ranks are shared.
std::vector<std::size_t> doubled_ranks(const std::vector<double>& sorted) {
  std::vector<std::size_t> ranks(sorted.size());
  for (std::size_t begin = 0, end = 0; begin < sorted.size(); begin = end) {
    while (end < sorted.size() && std::abs(sorted[end]) == std::abs(sorted[begin])) ++end;
    // Ranks begin + 1 ... end have the mean (begin + 1 + end) / 2.
    for (std::size_t i = begin; i < end; ++i) ranks[i] = begin + 1 + end;
  }
  return ranks;
}

/// Fraction of the 2^n sign patterns whose sum of positive (doubled) ranks is at most `sum`.
double exact_fraction(const std::vector<std::size_t>& ranks, std::size_t sum) {
  std::vector<double> fraction(sum + 1);  // of the patterns of the ranks so far, by their sum
  fraction[0] = 1;
  for (const std::size_t rank : ranks)
    for (std::size_t s = sum + 1; s-- > 0;)
      fraction[s] = (fraction[s] + (s >= rank ? fraction[s - rank] : 0)) / 2;
  double total = 0;
  for (const double f : fraction) total += f;
  return total;
}

/// The same by the normal distribution, whose variance is the sum of the squared ranks / 4.
double normal_fraction(const std::vector<std::size_t>& ranks, double smaller, double all) {
  double variance = 0;
  for (const std::size_t rank : ranks)
    variance += static_cast<double>(rank) * static_cast<double>(rank) / 4;
  // Sums of doubled ranks are 2 apart, of which the continuity correction is a half.
  const double z = (smaller + 1 - all / 2) / std::sqrt(variance);
  return std::erfc(-z / std::numbers::sqrt2) / 2;
}

}  // namespace

SignedRank signed_rank_test(std::span<const double> differences) {
  std::vector<double> sorted;
  for (const double difference : differences)
    if (difference != 0) sorted.push_back(difference);
  std::sort(sorted.begin(), sorted.end(),
            [](double a, double b) { return std::abs(a) < std::abs(b); });
  if (sorted.empty()) return {};
  const std::vector<std::size_t> ranks = doubled_ranks(sorted);
  std::size_t positive = 0, negative = 0;
  for (std::size_t i = 0; i < sorted.size(); ++i) (sorted[i] > 0 ? positive : negative) += ranks[i];
  const auto all = static_cast<double>(positive + negative);
  const std::size_t smaller = std::min(positive, negative);
  const double tail = sorted.size() <= kMostExact
                          ? exact_fraction(ranks, smaller)
                          : normal_fraction(ranks, static_cast<double>(smaller), all);
  return {sorted.size(), (static_cast<double>(positive) - static_cast<double>(negative)) / all,
          std::min(1.0, 2 * tail)};
}

}  // namespace saccade
