#include "eval/store/change_points.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/check.h"
#include "core/random.h"

namespace saccade {
namespace {

/// Consecutive commits, [begin, end).
struct Range {
  std::size_t begin = 0, end = 0;
};

/// The values of one seed in a range, less their mean, with their commits.
struct SeedResiduals {
  std::vector<std::size_t> commits;
  std::vector<double> values;
};

std::vector<SeedResiduals> residuals_of(const CommitValues& values, Range range) {
  std::vector<SeedResiduals> seeds;
  for (std::size_t seed = 0; seed < values[range.begin].size(); ++seed) {
    SeedResiduals one;
    double sum = 0;
    for (std::size_t commit = range.begin; commit < range.end; ++commit)
      if (const std::optional<double>& value = values[commit][seed]) {
        one.commits.push_back(commit);
        one.values.push_back(*value);
        sum += *value;
      }
    for (double& value : one.values) value -= sum / static_cast<double>(one.values.size());
    // A seed of a single commit says nothing of changes.
    if (one.values.size() > 1) seeds.push_back(std::move(one));
  }
  return seeds;
}

struct Split {
  std::size_t at = 0;
  double strength = 0;
};

/// The values of all seeds sum to 0, so that the sum to the left says the difference.
Split best_split(const std::vector<SeedResiduals>& seeds, Range range) {
  std::vector<double> sums(range.end - range.begin), counts(sums.size());
  double total = 0;
  for (const SeedResiduals& seed : seeds)
    for (std::size_t i = 0; i < seed.values.size(); ++i) {
      sums[seed.commits[i] - range.begin] += seed.values[i];
      counts[seed.commits[i] - range.begin] += 1;
      total += 1;
    }
  Split best;
  double left = 0, count = 0;
  for (std::size_t i = 0; i + 1 < sums.size(); ++i) {
    left += sums[i];
    count += counts[i];
    if (count == 0 || count == total) continue;
    const double strength = std::abs(left) * std::sqrt(total / (count * (total - count)));
    if (strength > best.strength) best = {range.begin + i + 1, strength};
  }
  return best;
}

/// Fisher-Yates; `stream` identifies the permutation.
void shuffle(std::vector<double>& values, const Random& random, std::uint64_t stream,
             std::uint64_t first) {
  for (std::size_t i = values.size(); i > 1; --i)
    std::swap(values[i - 1], values[static_cast<std::size_t>(random.below(i, stream, first + i))]);
}

double p_value(std::vector<SeedResiduals> seeds, Range range, double strength,
               const ChangeOptions& options) {
  constexpr double kRounding = 1 - 1e-9;  // equal permutations differ in the order of their sums
  const Random random(options.seed);
  std::size_t as_strong = 1;
  for (std::uint64_t k = 0; k < options.permutations; ++k) {
    std::uint64_t first = 0;
    for (SeedResiduals& seed : seeds) {
      shuffle(seed.values, random, k, first);
      first += seed.values.size() + 1;
    }
    if (best_split(seeds, range).strength >= strength * kRounding) ++as_strong;
  }
  return static_cast<double>(as_strong) / static_cast<double>(options.permutations + 1);
}

double mean_of(const CommitValues& values, Range range) {
  double sum = 0, count = 0;
  for (std::size_t commit = range.begin; commit < range.end; ++commit)
    for (const std::optional<double>& value : values[commit])
      if (value) {
        sum += *value;
        ++count;
      }
  return sum / count;
}

void search(const CommitValues& values, Range range, const ChangeOptions& options,
            std::vector<ChangePoint>& found) {
  if (range.end - range.begin < 2) return;
  const std::vector<SeedResiduals> seeds = residuals_of(values, range);
  const Split split = best_split(seeds, range);
  if (split.strength == 0) return;
  const Range left{range.begin, split.at}, right{split.at, range.end};
  const ChangePoint change{split.at, mean_of(values, left), mean_of(values, right),
                           p_value(seeds, range, split.strength, options)};
  if (change.p > options.alpha) return;
  search(values, left, options, found);
  if (std::abs(change.after - change.before) > options.least_difference) found.push_back(change);
  search(values, right, options, found);
}

/// The levels between the changes that count, which the search knew within its ranges alone.
void set_levels(const CommitValues& values, std::vector<ChangePoint>& found) {
  for (std::size_t i = 0; i < found.size(); ++i) {
    const std::size_t begin = i == 0 ? 0 : found[i - 1].at;
    const std::size_t end = i + 1 == found.size() ? values.size() : found[i + 1].at;
    found[i].before = mean_of(values, {begin, found[i].at});
    found[i].after = mean_of(values, {found[i].at, end});
  }
}

}  // namespace

std::vector<ChangePoint> change_points(const CommitValues& values, const ChangeOptions& options) {
  SACCADE_CHECK(options.permutations >= 99);
  for (const auto& commit : values) SACCADE_CHECK(commit.size() == values.front().size());
  std::vector<ChangePoint> found;
  if (!values.empty()) search(values, {0, values.size()}, options, found);
  set_levels(values, found);
  return found;
}

}  // namespace saccade
