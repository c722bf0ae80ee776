#include "eval/gate/comparison.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "core/check.h"
#include "core/error.h"
#include "core/median.h"
#include "eval/gate/bootstrap.h"
#include "eval/gate/effect.h"

namespace saccade {
namespace {

using Verdict = GateRow::Verdict;

double mean_of(const std::vector<double>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

bool has_enough_pairs(const Effect& effect) {
  return effect.log_ratios.size() >= kLeastForBootstrap;
}

GateRow row_of(const Effect& effect) {
  const auto n = static_cast<double>(effect.log_ratios.size());
  GateRow row;
  row.metric = effect.metric.key;
  row.scope = effect.scope;
  row.pairs = effect.log_ratios.size();
  row.before = effect.before_sum / n;
  row.after = effect.after_sum / n;
  row.change = relative_change(effect.metric, mean_of(effect.log_ratios));
  return row;
}

Verdict verdict_of(double worse, double threshold, bool sure_worse, bool sure_better) {
  if (sure_worse && worse > threshold) return Verdict::kRegressed;
  return sure_better && worse < -threshold ? Verdict::kImproved : Verdict::kSame;
}

/// For fewer pairs than the bootstrap needs: a metric changes beyond `options.gross`, a time beyond
/// `options.slower` where the repetitions of both sides do not overlap.
GateRow judge_few_pairs(const Effect& effect, const GateOptions& options) {
  const double worse = mean_of(effect.log_ratios);
  const double threshold = effect.is_time() ? std::log(options.slower) : std::log1p(options.gross);
  const bool sure = !effect.is_time() || effect.times_separated;
  GateRow row = row_of(effect);
  row.verdict = verdict_of(worse, threshold, sure, !effect.is_time());
  row.note = effect.is_time()
                 ? "few pairs, judged by repetitions that do not overlap"
                 : fmt::format("few pairs, judged by {:g} % alone", 100 * options.gross);
  return row;
}

/// At least `options.resamples`, and enough that kBeyond of them lie beyond the corrected level.
ResampleOptions bootstrap_options(std::size_t tests, const GateOptions& options) {
  constexpr double kBeyond = 5;
  ResampleOptions bootstrap;
  bootstrap.tail = (1 - options.confidence) / static_cast<double>(tests);
  bootstrap.resamples = std::max(options.resamples, static_cast<int>(kBeyond / bootstrap.tail));
  bootstrap.seed = options.seed;
  return bootstrap;
}

/// Adds the rows of the effects with enough pairs, their p-values corrected for their number.
void judge_by_bootstrap(std::span<const Effect* const> effects, const GateOptions& options,
                        GateResult& result) {
  const double alpha = 1 - options.confidence;
  const ResampleOptions bootstrap = bootstrap_options(effects.size(), options);
  std::vector<BootstrapMean> means;
  std::vector<double> above, below;
  for (const Effect* effect : effects) {
    means.push_back(bootstrap_mean(effect->log_ratios, bootstrap));
    above.push_back(means.back().p_above);
    below.push_back(means.back().p_below);
  }
  above = holm(above);
  below = holm(below);
  for (std::size_t i = 0; i < effects.size(); ++i) {
    const Effect& effect = *effects[i];
    GateRow row = row_of(effect);
    const auto [low, high] = std::minmax({relative_change(effect.metric, means[i].low),
                                          relative_change(effect.metric, means[i].high)});
    row.low = low;
    row.high = high;
    row.p = means[i].mean > 0 ? above[i] : below[i];
    row.verdict =
        verdict_of(means[i].mean, effect.threshold(options), above[i] < alpha, below[i] < alpha);
    result.rows.push_back(row);
  }
}

void check_number(bool holds, const char* option, const char* rule) {
  if (!holds) throw InputError(option, rule);
}

}  // namespace

void GateOptions::check() const {
  check_number(tolerance > 0 && tolerance < 1, "--tolerance", "must lie between 0 and 1");
  check_number(gross > 0 && std::isfinite(gross), "--gross", "must be above 0");
  check_number(slower > 1 && std::isfinite(slower), "--slower", "must be above 1");
  check_number(confidence > 0.5 && confidence < 1, "--confidence", "must lie between 0.5 and 1");
  check_number(resamples >= 100, "--resamples", "must be at least 100");
}

std::size_t GateResult::count(GateRow::Verdict verdict) const {
  return static_cast<std::size_t>(std::count_if(
      rows.begin(), rows.end(), [&](const GateRow& row) { return row.verdict == verdict; }));
}

std::vector<double> holm(std::span<const double> p) {
  std::vector<std::size_t> order(p.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return p[a] < p[b]; });
  std::vector<double> corrected(p.size());
  double largest = 0;
  for (std::size_t i = 0; i < order.size(); ++i) {
    largest = std::max(largest, static_cast<double>(p.size() - i) * p[order[i]]);
    corrected[order[i]] = std::min(1.0, largest);
  }
  return corrected;
}

GateResult compare_runs(std::span<const GateRun> baseline, std::span<const GateRun> runs,
                        const GateOptions& options) {
  options.check();
  SACCADE_CHECK(!baseline.empty() && !runs.empty());
  GateResult result;
  const std::vector<GatePair> pairs = match_runs(baseline, runs, options.partial, result);
  note_other_data(pairs, result);
  add_missing_metrics(pairs, options.speed, result);
  add_changed_signs(pairs, result);
  const std::vector<Effect> effects = collect_effects(pairs, options, result);
  std::vector<const Effect*> bootstrapped;
  for (const Effect& effect : effects) {
    if (has_enough_pairs(effect))
      bootstrapped.push_back(&effect);
    else if (!effect.pooled)
      result.rows.push_back(judge_few_pairs(effect, options));
  }
  if (!bootstrapped.empty()) judge_by_bootstrap(bootstrapped, options, result);
  std::stable_sort(result.rows.begin(), result.rows.end(),
                   [](const GateRow& a, const GateRow& b) { return a.verdict < b.verdict; });
  return result;
}

GateResult compare_times(std::span<const double> first_s, std::span<const double> second_s,
                         const GateOptions& options) {
  options.check();
  SACCADE_CHECK(!first_s.empty() && first_s.size() == second_s.size());
  const ResampleOptions bootstrap = bootstrap_options(1, options);
  const BootstrapRatio found = bootstrap_paired_ratio(second_s, first_s, bootstrap);
  GateRow row;
  row.metric = "wall time [s]";
  row.scope = "second build against the first";
  row.pairs = first_s.size();
  row.before = median({first_s.begin(), first_s.end()});
  row.after = median({second_s.begin(), second_s.end()});
  row.change = found.ratio - 1;
  row.low = found.low - 1;
  row.high = found.high - 1;
  row.verdict =
      verdict_of(std::log1p(*row.change), std::log(options.slower), found.low > 1, found.high < 1);
  GateResult result{{row}, {}};
  if (!result.tripped() && found.high > options.slower)
    result.notes.push_back(
        "the times scatter too much to exclude a change that counts as slower; more --repeats or "
        "an "
        "idle machine narrow the interval");
  return result;
}

}  // namespace saccade
