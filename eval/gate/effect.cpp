#include "eval/gate/effect.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "core/error.h"
#include "eval/metrics/catalogue.h"

namespace saccade {
namespace {

/// With fewer repetitions the scatter of the times is unknown.
constexpr double kMinRepetitions = 5;

std::vector<MetricInfo> judged_metrics(const GateOptions& options) {
  std::vector<MetricInfo> metrics(gate_metrics().begin(), gate_metrics().end());
  for (const std::string& key : options.metrics) {
    if (metric_info(key).better == MetricInfo::Better::kNeither)
      throw InputError("--metric",
                       "'" + key + "' cannot be judged: neither lower nor higher is better");
    if (std::none_of(metrics.begin(), metrics.end(),
                     [&](const MetricInfo& metric) { return metric.key == key; }))
      metrics.push_back(metric_info(key));
  }
  if (options.speed) metrics.push_back(metric_info(std::string(kGateTime)));
  return metrics;
}

bool same_machine(const GatePair& pair) {
  return pair.before->machine == pair.after->machine && pair.before->threads == pair.after->threads;
}

/// Whether the slowest repetition of the baseline is faster than the fastest of the run.
bool have_separated_times(const GatePair& pair) {
  const auto enough = [](const GateRun& run) {
    return run.get("speed.repetitions").value_or(0) >= kMinRepetitions;
  };
  const std::optional<double> slowest = pair.before->get("speed.wall_s.max");
  const std::optional<double> fastest = pair.after->get("speed.wall_s.min");
  return enough(*pair.before) && enough(*pair.after) && slowest && fastest && *fastest > *slowest;
}

/// Adds the log ratio of a pair; false where it is undefined.
bool add_pair(Effect& effect, const GatePair& pair) {
  const std::optional<double> before = pair.before->get(effect.metric.key);
  const std::optional<double> after = pair.after->get(effect.metric.key);
  const std::optional<double> worse = worsening(effect.metric, *before, *after);
  if (!worse) return false;
  effect.log_ratios.push_back(*worse);
  effect.before_sum += *before;
  effect.after_sum += *after;
  effect.times_separated = effect.times_separated && have_separated_times(pair);
  return true;
}

void add_sign_row(const std::string& metric, const GatePair& pair, GateResult& result) {
  GateRow row;
  row.before = pair.before->get(metric);
  row.after = pair.after->get(metric);
  if (*row.before <= *row.after) return;  // the baseline was outside the domain already
  row.verdict = GateRow::Verdict::kRegressed;
  row.metric = metric;
  row.scope = pair.after->key.text();
  row.pairs = 1;
  row.note = "changed sign";
  result.rows.push_back(row);
}

/// The effects of a module by the name of the sequence.
using Sequences = std::map<std::string, Effect>;

void append(Effect& pool, const Effect& sequence) {
  pool.log_ratios.insert(pool.log_ratios.end(), sequence.log_ratios.begin(),
                         sequence.log_ratios.end());
  pool.before_sum += sequence.before_sum;
  pool.after_sum += sequence.after_sum;
}

void add_effects(const std::string& module, const Sequences& sequences,
                 std::vector<Effect>& effects) {
  Effect pool{sequences.begin()->second.metric, "", true, {}, 0, 0, false};
  for (const auto& [name, sequence] : sequences) {
    effects.push_back(sequence);
    append(pool, sequence);
  }
  pool.scope = fmt::format("{}, {} sequences", module, sequences.size());
  if (sequences.size() > 1) effects.push_back(pool);
}

std::map<std::string, Sequences> sequences_of(std::span<const GatePair> pairs,
                                              const MetricInfo& metric, GateResult& result) {
  std::map<std::string, Sequences> modules;
  for (const GatePair& pair : pairs) {
    if (!pair.before->get(metric.key) || !pair.after->get(metric.key)) continue;
    const GateKey& key = pair.before->key;
    Effect sequence{metric, key.sequence(), false, {}, 0, 0, true};
    Sequences& sequences = modules[key.module];
    const auto known = sequences.find(sequence.scope);
    Effect& effect = known == sequences.end() ? sequence : known->second;
    if (!add_pair(effect, pair))
      add_sign_row(metric.key, pair, result);
    else if (known == sequences.end())
      sequences.emplace(sequence.scope, sequence);
  }
  std::erase_if(modules, [](const auto& module) { return module.second.empty(); });
  return modules;
}

std::vector<GatePair> pairs_on_one_machine(std::span<const GatePair> pairs, GateResult& result) {
  std::vector<GatePair> same;
  std::copy_if(pairs.begin(), pairs.end(), std::back_inserter(same), same_machine);
  if (const std::size_t other = pairs.size() - same.size(); other > 0)
    result.notes.push_back(fmt::format(
        "times of {} of {} pairs not compared: another machine or number of threads ({}; was {})",
        other, pairs.size(), pairs.front().after->machine, pairs.front().before->machine));
  return same;
}

}  // namespace

double Effect::threshold(const GateOptions& options) const {
  if (is_time()) return std::log(options.slower);
  return std::log1p(metric.tolerance.value_or(options.tolerance));
}

std::vector<Effect> collect_effects(std::span<const GatePair> pairs, const GateOptions& options,
                                    GateResult& result) {
  const std::vector<GatePair> timed =
      options.speed ? pairs_on_one_machine(pairs, result) : std::vector<GatePair>{};
  std::vector<Effect> effects;
  for (const MetricInfo& metric : judged_metrics(options)) {
    const bool is_time = metric.key == kGateTime;
    const auto modules =
        sequences_of(is_time ? std::span<const GatePair>(timed) : pairs, metric, result);
    for (const auto& [module, sequences] : modules) add_effects(module, sequences, effects);
    const bool asked = std::find(options.metrics.begin(), options.metrics.end(), metric.key) !=
                       options.metrics.end();
    if (asked && modules.empty())
      throw InputError("--metric", "no pair of runs has a '" + metric.key + "' above 0");
  }
  return effects;
}

}  // namespace saccade
