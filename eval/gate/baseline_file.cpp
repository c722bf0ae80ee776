#include "eval/gate/baseline_file.h"

#include <algorithm>
#include <set>
#include <utility>

#include "core/config/config.h"
#include "core/error.h"
#include "core/io/files/atomic_file.h"

namespace saccade {
namespace {

/// The contents of a baseline file.
struct Baseline {
  int format_version = 1;
  std::vector<GateRun> runs;
};

void describe(config::Fields& fields, Baseline& baseline) {
  fields.value("format_version", baseline.format_version, "Version of the format of this file.")
      .required()
      .range(1, 1);
  fields.list("runs", baseline.runs, "The scored runs, sorted by key.").required();
}

void sort_by_key(std::vector<GateRun>& runs) {
  std::sort(runs.begin(), runs.end(),
            [](const GateRun& a, const GateRun& b) { return a.key < b.key; });
}

}  // namespace

void describe(config::Fields& fields, GateRun& run) {
  fields.value("dataset", run.key.dataset, "Name of the dataset's folder.").required();
  fields.value("module", run.key.module, "Module of `saccade run`.").required();
  fields
      .value("config", run.key.config, "Name of the configuration file and the overrides of --set.")
      .required();
  fields.value("seed", run.key.seed, "Seed of the run.").required();
  fields.value("machine", run.machine, "Processor and operating system.");
  fields.value("threads", run.threads, "Number of threads; 0 where it is not stated.").at_least(0);
  fields.value("tool_version", run.tool_version, "Version of saccade that made the run.");
  fields.value("metrics", run.metrics, "Metrics by dotted key.").required();
}

std::vector<GateRun> read_baseline(const std::filesystem::path& file) {
  auto baseline = config::read<Baseline>(config::load(file));
  if (baseline.runs.empty()) throw InputError(file.string(), "runs: must not be empty");
  sort_by_key(baseline.runs);
  for (std::size_t i = 1; i < baseline.runs.size(); ++i)
    if (baseline.runs[i].key == baseline.runs[i - 1].key)
      throw InputError(file.string(), "holds " + baseline.runs[i].key.text() + " twice");
  return std::move(baseline.runs);
}

void write_baseline(const std::filesystem::path& file, std::vector<GateRun> runs) {
  sort_by_key(runs);
  write_atomically(file, config::print(Baseline{1, std::move(runs)}));
}

GateResult compare_with_baseline(const std::filesystem::path& file, std::span<const GateRun> runs,
                                 const GateOptions& options) {
  if (!std::filesystem::exists(file))
    throw InputError(file.string(), "does not exist; --update writes it");
  return compare_runs(read_baseline(file), runs, options);
}

std::size_t update_baseline(const std::filesystem::path& file, std::vector<GateRun> runs,
                            bool partial) {
  if (partial && std::filesystem::exists(file)) {
    std::set<GateKey> given;
    for (const GateRun& run : runs) given.insert(run.key);
    for (const GateRun& old : read_baseline(file))
      if (!given.contains(old.key)) runs.push_back(old);
  }
  const std::size_t count = runs.size();
  write_baseline(file, std::move(runs));
  return count;
}

}  // namespace saccade
