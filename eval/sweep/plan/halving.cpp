#include "eval/sweep/plan/halving.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <optional>
#include <tuple>
#include <utility>

#include "core/config/suggest.h"
#include "core/error.h"
#include "core/io/run/run_record.h"
#include "eval/evaluate.h"
#include "eval/metrics/catalogue.h"

namespace saccade {
namespace {

constexpr std::size_t kNone = std::numeric_limits<std::size_t>::max();
/// Of fewer rows none is stopped: a comparison needs two.
constexpr std::size_t kFewestRows = 2;

using Pair = std::pair<std::filesystem::path, std::optional<std::uint64_t>>;

/// The pairs of dataset and seed, one of each dataset in turn.
std::vector<Pair> pairs_of(const std::vector<SweepJob>& runs) {
  std::vector<std::pair<std::filesystem::path, std::vector<std::optional<std::uint64_t>>>> datasets;
  std::map<std::filesystem::path, std::size_t> known;
  for (const SweepJob& run : runs) {
    const auto [found, is_new] = known.emplace(run.dataset, datasets.size());
    if (is_new) datasets.push_back({run.dataset, {}});
    auto& seeds = datasets[found->second].second;
    if (std::find(seeds.begin(), seeds.end(), run.point.seed) == seeds.end())
      seeds.push_back(run.point.seed);
  }
  std::vector<Pair> pairs;
  for (std::size_t k = 0, before = 1; before > 0; ++k) {
    before = pairs.size();
    for (const auto& [dataset, seeds] : datasets)
      if (k < seeds.size()) pairs.emplace_back(dataset, seeds[k]);
    before = pairs.size() - before;
  }
  return pairs;
}

/// Its value such that less is better; infinite where it has none.
double loss_of(const SweepJob& run, const MetricInfo& metric) {
  constexpr double kWorst = std::numeric_limits<double>::infinity();
  if (run.state == JobState::kFailed) return kWorst;
  try {
    // An external program that crashed has a time, but came to nothing.
    const std::filesystem::path record = run.output / "run.yaml";
    if (std::filesystem::exists(record) && !read_run_record(record).problem().empty())
      return kWorst;
    const std::optional<double> value = speed_value(read_json_metrics(run.scores), metric.key);
    if (!value) return kWorst;
    return metric.higher_is_better() ? -*value : *value;
  } catch (const InputError&) {
    return kWorst;
  }
}

/// The scores of the first run that has any.
std::vector<std::string> known_keys(const std::vector<SweepJob>& runs) {
  std::vector<std::string> keys;
  for (const SweepJob& run : runs) {
    if (run.state == JobState::kHeld || !std::filesystem::exists(run.scores)) continue;
    const Metrics metrics = read_json_metrics(run.scores);
    for (const auto& [key, value] : metrics.values()) keys.push_back(key);
    break;
  }
  return keys;
}

/// The rank of each value, from 1 on; equal ones share the mean of theirs.
std::vector<double> ranks_of(const std::vector<double>& values) {
  std::vector<std::size_t> order(values.size());
  std::iota(order.begin(), order.end(), 0U);
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return values[a] < values[b]; });
  std::vector<double> ranks(values.size());
  for (std::size_t i = 0; i < order.size();) {
    std::size_t end = i + 1;
    while (end < order.size() && values[order[end]] == values[order[i]]) ++end;
    const double shared = (static_cast<double>(i + 1) + static_cast<double>(end)) / 2;
    for (; i < end; ++i) ranks[order[i]] = shared;
  }
  return ranks;
}

}  // namespace

void describe(config::Fields& fields, HalvingConfig& halving) {
  fields.value("metric", halving.metric, "Metric by which the rows are ranked.").required();
  fields
      .value("first", halving.first,
             "Pairs of dataset and seed that every row runs over before the first are stopped. "
             "Few may stop the best by chance.")
      .range(1, 1e6);
  fields
      .value(
          "keep", halving.keep,
          "Share of the rows that goes on after each round, which runs over twice as many pairs.")
      .range(0.05, 0.95);
  fields.expect(!is_catalogued(halving.metric) ||
                    metric_info(halving.metric).better != MetricInfo::Better::kNeither,
                "metric", "is neither better when it is lower nor when it is higher");
}

Halving::Halving(const HalvingConfig& config, std::string reference, std::vector<SweepJob>& runs)
    : config_(config), reference_(std::move(reference)), runs_(runs) {
  const std::vector<Pair> pairs = pairs_of(runs);
  pairs_ = pairs.size();
  std::map<Pair, std::size_t> index_of_pair;
  for (std::size_t i = 0; i < pairs.size(); ++i) index_of_pair[pairs[i]] = i;
  using Key = std::tuple<std::string, std::string, std::vector<std::string>>;
  std::map<Key, std::size_t> known;
  for (std::size_t i = 0; i < runs.size(); ++i) {
    SweepJob& run = runs[i];
    const auto [found, is_new] = known.emplace(
        Key{run.point.configuration, run.point.variant, run.point.grid}, rows_.size());
    if (is_new) rows_.push_back({run.point, std::vector<std::size_t>(pairs_, kNone)});
    rows_[found->second].runs[index_of_pair.at({run.dataset, run.point.seed})] = i;
    run.state = JobState::kHeld;
  }
  release_next();
}

bool Halving::release_next() {
  if (released_ == pairs_) return false;
  if (released_ > 0) stop_rows();
  const auto first = static_cast<std::size_t>(config_.first);
  const std::size_t until = std::min(pairs_, released_ == 0 ? first : 2 * released_);
  for (const Row& row : rows_)
    for (std::size_t pair = released_; row.is_left && pair < until; ++pair)
      if (row.runs[pair] != kNone) runs_[row.runs[pair]].state = JobState::kPending;
  released_ = until;
  return true;
}

std::vector<double> Halving::mean_ranks(const std::vector<const Row*>& rows) const {
  const MetricInfo metric = metric_info(config_.metric);
  std::vector<double> sums(rows.size()), counts(rows.size());
  bool is_measured = false;
  for (std::size_t pair = 0; pair < released_; ++pair) {
    std::vector<std::size_t> present;
    std::vector<double> losses;
    for (std::size_t i = 0; i < rows.size(); ++i) {
      if (rows[i]->runs[pair] == kNone) continue;
      present.push_back(i);
      losses.push_back(loss_of(runs_[rows[i]->runs[pair]], metric));
      is_measured = is_measured || std::isfinite(losses.back());
    }
    const std::vector<double> ranks = ranks_of(losses);
    for (std::size_t k = 0; k < present.size(); ++k) {
      // Where only some rows have the pair, the rank counts relative to their number.
      sums[present[k]] += (ranks[k] - 0.5) / static_cast<double>(present.size());
      counts[present[k]] += 1;
    }
  }
  // Of a row without any pair so far nothing is known: it is in the middle.
  for (std::size_t i = 0; i < rows.size(); ++i) sums[i] = counts[i] > 0 ? sums[i] / counts[i] : 0.5;
  if (!is_measured)
    throw InputError("halving.metric",
                     "'" + config_.metric + "' is a score of no run so far; " +
                         config::suggestion(config_.metric, known_keys(runs_), "metrics"));
  return sums;
}

void Halving::stop_rows() {
  std::vector<const Row*> left;
  std::vector<std::size_t> indices;
  for (std::size_t i = 0; i < rows_.size(); ++i)
    if (rows_[i].is_left) {
      left.push_back(&rows_[i]);
      indices.push_back(i);
    }
  const auto kept = std::max(
      kFewestRows,
      static_cast<std::size_t>(std::ceil(config_.keep * static_cast<double>(left.size()))));
  if (left.size() <= kept) return;
  const std::vector<double> ranks = mean_ranks(left);
  std::vector<std::size_t> order(left.size());
  std::iota(order.begin(), order.end(), 0U);
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return ranks[a] < ranks[b]; });
  for (std::size_t place = kept; place < order.size(); ++place) {
    Row& row = rows_[indices[order[place]]];
    const bool is_reference = !reference_.empty() && (row.point.variant == reference_ ||
                                                      row.point.configuration == reference_);
    if (is_reference) continue;
    row.is_left = false;
    stopped_.push_back({row.point, place + 1, left.size(), released_});
  }
}

}  // namespace saccade
