#include "eval/report/run_set_comparison.h"

#include <algorithm>
#include <map>
#include <optional>
#include <set>

#include "core/error.h"

namespace saccade {
namespace {

using RunsByKey = std::map<GateKey, const RunData*>;

GateKey key_of(const RunData& run, bool with_config) {
  GateKey key = gate_run(run.run.record, run.metrics).key;
  if (!with_config) key.config.clear();
  return key;
}

RunsByKey by_key(std::span<const RunData> runs, bool with_config) {
  RunsByKey keys;
  for (const RunData& run : runs) {
    const auto [first, is_new] = keys.emplace(key_of(run, with_config), &run);
    if (!is_new)
      throw InputError(run.run.folder.string(),
                       "is the same work as " + first->second->run.folder.string() + " (" +
                           first->first.text() + "); the runs of a side must differ in it");
  }
  return keys;
}

bool has_pair(std::span<const RunData> before, std::span<const RunData> after, bool with_config) {
  std::set<GateKey> keys;
  for (const RunData& run : before) keys.insert(key_of(run, with_config));
  return std::any_of(after.begin(), after.end(),
                     [&](const RunData& run) { return keys.contains(key_of(run, with_config)); });
}

std::vector<GateRun> gate_runs(const RunsByKey& runs) {
  std::vector<GateRun> result;
  for (const auto& [key, run] : runs) {
    result.push_back(gate_run(run->run.record, run->metrics));
    result.back().key = key;
  }
  return result;
}

/// What all runs of a side have in common; nullopt where they differ.
template <typename Property>
std::optional<std::string> common(std::span<const RunData> runs, const Property& property) {
  const std::string first = property(runs.front());
  const bool all = std::all_of(runs.begin(), runs.end(),
                               [&](const RunData& run) { return property(run) == first; });
  return all && !first.empty() ? std::optional(first) : std::nullopt;
}

template <typename Property>
bool set_names(RunSetComparison& comparison, std::span<const RunData> before,
               std::span<const RunData> after, const Property& property) {
  const auto a = common(before, property), b = common(after, property);
  if (!a || !b || *a == *b) return false;
  comparison.a = *a;
  comparison.b = *b;
  return true;
}

}  // namespace

RunSetComparison compare_run_sets(std::span<const RunData> before, std::span<const RunData> after) {
  const bool with_config = has_pair(before, after, true);
  if (!with_config && !has_pair(before, after, false))
    throw InputError("--against",
                     "none of its runs has a partner of the same dataset, module and "
                     "seed");
  const RunsByKey a = by_key(before, with_config), b = by_key(after, with_config);
  RunSetComparison comparison;
  const bool named =
      set_names(comparison, before, after, [](const RunData& run) { return run.method; }) ||
      set_names(comparison, before, after,
                [](const RunData& run) { return run.run.record.tool_version; });
  if (!named) {
    comparison.a = "before";
    comparison.b = "after";
  }
  for (const RunData& run : after) {
    const GateKey key = key_of(run, with_config);
    if (const auto partner = a.find(key); partner != a.end())
      comparison.pairs.push_back({key.sequence(), partner->second, &run});
  }
  GateOptions options;
  options.partial = true;
  comparison.result = compare_runs(gate_runs(a), gate_runs(b), options);
  return comparison;
}

}  // namespace saccade
