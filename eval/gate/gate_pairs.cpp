#include "eval/gate/gate_pairs.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "core/error.h"
#include "eval/gate/gate_metric.h"

namespace saccade {
namespace {

/// The pairs with one fault, by metric.
using AffectedPairs = std::map<std::string, std::vector<GatePair>>;

const GateRun* find(std::span<const GateRun> runs, const GateKey& key) {
  const auto found =
      std::find_if(runs.begin(), runs.end(), [&](const GateRun& run) { return run.key == key; });
  return found == runs.end() ? nullptr : &*found;
}

void add_regressions(const AffectedPairs& affected, const std::string& note, GateResult& result) {
  for (const auto& [metric, pairs] : affected) {
    const GatePair& first = pairs.front();
    GateRow row;
    row.verdict = GateRow::Verdict::kRegressed;
    row.metric = metric;
    row.scope = first.after->key.text();
    if (pairs.size() > 1) row.scope += fmt::format(" and {} more", pairs.size() - 1);
    row.pairs = pairs.size();
    row.before = first.before->get(metric);
    row.after = first.after->get(metric);
    row.note = note;
    result.rows.push_back(row);
  }
}

}  // namespace

std::vector<GatePair> match_runs(std::span<const GateRun> baseline, std::span<const GateRun> runs,
                                 bool partial, GateResult& result) {
  std::vector<GatePair> pairs;
  for (const GateRun& before : baseline) {
    if (const GateRun* after = find(runs, before.key)) {
      pairs.push_back({&before, after});
    } else if (!partial) {
      GateRow row;
      row.verdict = GateRow::Verdict::kRegressed;
      row.metric = "the run";
      row.scope = before.key.text();
      row.note = "missing";
      result.rows.push_back(row);
    }
  }
  for (const GateRun& after : runs)
    if (find(baseline, after.key) == nullptr)
      result.notes.push_back("not in the baseline: " + after.key.text());
  if (pairs.empty())
    throw InputError("--baseline", "none of the runs is in it: it holds " +
                                       baseline.front().key.text() + " and not " +
                                       runs.front().key.text());
  return pairs;
}

void add_missing_metrics(std::span<const GatePair> pairs, bool speed, GateResult& result) {
  AffectedPairs missing;
  for (const GatePair& pair : pairs)
    for (const auto& [metric, value] : pair.before->metrics)
      if (value && !pair.after->get(metric) && (speed || !metric.starts_with("speed.")))
        missing[metric].push_back(pair);
  add_regressions(missing, "missing", result);
}

void add_changed_signs(std::span<const GatePair> pairs, GateResult& result) {
  AffectedPairs changed;
  for (const GatePair& pair : pairs)
    for (const auto& [metric, before] : pair.before->metrics) {
      const std::optional<double> after = pair.after->get(metric);
      if (is_judged_by_sign(metric) && before && after && *before * *after < 0)
        changed[metric].push_back(pair);
    }
  add_regressions(changed, "changed sign", result);
}

void note_other_data(std::span<const GatePair> pairs, GateResult& result) {
  for (const GatePair& pair : pairs) {
    const std::optional<double> before = pair.before->get("speed.events");
    const std::optional<double> after = pair.after->get("speed.events");
    if (before && after && *before != *after)
      result.notes.push_back(fmt::format("{}: {} events in place of {}; not the same data",
                                         pair.after->key.text(), *after, *before));
  }
}

}  // namespace saccade
