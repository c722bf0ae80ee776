#include "eval/gate/baseline_file.h"

#include <algorithm>
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

void describe(config::Fields& fields, MachineTimes& times) {
  fields.value("machine", times.machine, "Processor and operating system.").required();
  fields.value("threads", times.threads, "Number of threads.").at_least(0);
  fields.value("metrics", times.metrics, "Times by dotted key.").required();
}

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
  // Most baselines are of one machine: they have no such key.
  if (fields.reading() || !run.elsewhere.empty())
    fields.list("elsewhere", run.elsewhere, "Times on other kinds of machines.");
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
  std::vector<GateRun> baseline = read_baseline(file);
  std::vector<GateRun> given(runs.begin(), runs.end());
  leave_out_compared(baseline, given, options.compared);
  take_times_of_same_machine(baseline, given);
  return compare_runs(baseline, given, options);
}

std::size_t update_baseline(const std::filesystem::path& file, std::vector<GateRun> runs,
                            bool partial) {
  if (std::filesystem::exists(file)) {
    for (const GateRun& old : read_baseline(file)) {
      const auto given = std::find_if(runs.begin(), runs.end(),
                                      [&](const GateRun& run) { return run.key == old.key; });
      if (given != runs.end())
        keep_times_of_other_machines(*given, old);
      else if (partial)
        runs.push_back(old);
    }
  }
  const std::size_t count = runs.size();
  write_baseline(file, std::move(runs));
  return count;
}

}  // namespace saccade
