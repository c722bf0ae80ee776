#include "apps/submission.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <string>
#include <system_error>
#include <vector>

#include "core/config/config.h"
#include "core/error.h"
#include "core/io/files/folder_name.h"
#include "core/io/run/run_record.h"
#include "core/median.h"
#include "core/process/progress.h"
#include "core/process/shell.h"
#include "estimator/external/adapter_config.h"
#include "estimator/external/external_process.h"
#include "eval/metrics/metrics.h"
#include "eval/sweep/plan/plan.h"
#include "eval/sweep/sweep_folder.h"

namespace saccade {
namespace {

namespace fs = std::filesystem;

/// Compiling a program and fetching what it needs.
constexpr double kPrepareTimeoutS = 3600;

fs::path adapter_of(const fs::path& submission) { return submission / "adapter.yaml"; }

AdapterConfig read_submission(const fs::path& submission) {
  const fs::path file = adapter_of(submission);
  if (!fs::exists(file))
    throw InputError(submission.string(),
                     "holds no adapter.yaml (--submission); docs/submissions.md describes one");
  auto adapter = config::read<AdapterConfig>(config::load(file));
  if (adapter.licence.empty())
    throw InputError(file.string(), "lacks 'licence', which a submission must state");
  if (!adapter.method_class)
    throw InputError(file.string(), "lacks 'class': a submission is ranked in its class");
  return adapter;
}

/// Of the runs of a configuration, computing time for a second of recording [s]; nullopt without one.
std::optional<double> measured_s(const SweepPlan& plan, const std::string& configuration) {
  std::vector<double> times;
  for (const SweepJob& run : plan.runs) {
    if (run.point.configuration != configuration || !fs::exists(run.scores)) continue;
    // What crashed took a time, too, but not that of its work.
    if (!read_run_record(run.output / "run.yaml").problem().empty()) continue;
    const std::optional<double> factor =
        read_json_metrics(run.scores).get("speed.realtime_factor.median");
    if (factor && *factor > 0) times.push_back(1 / *factor);
  }
  return times.empty() ? std::nullopt : std::optional(median(times));
}

std::string time_text(const AdapterConfig& adapter, const std::optional<double>& measured) {
  std::string text;
  if (measured) text += fmt::format(", {:.3g} s per second of recording", *measured);
  if (adapter.expected_s) text += fmt::format(", {:.3g} s stated", *adapter.expected_s);
  return text;
}

}  // namespace

void add_submissions(SweepConfig& sweep, std::span<const fs::path> folders) {
  if (folders.empty()) return;
  if (!sweep.grid.empty() || !sweep.variants.empty())
    throw InputError("--submission",
                     "goes not with a sweep that has 'grid' or 'variants', which are keys of a "
                     "module");
  if (sweep.generate && sweep.generate->disk_gb)
    throw InputError("--submission",
                     "goes not with 'generate.disk_gb', which makes datasets alone");
  for (const SweepDataset& dataset : sweep.datasets)
    if (!dataset.against.empty())
      throw InputError("--submission", "goes not with datasets that are scored 'against' others");
  for (const fs::path& folder : folders) {
    static_cast<void>(read_submission(folder));
    SweepConfiguration configuration;
    configuration.name = folder_name(folder);
    configuration.adapter = fs::absolute(adapter_of(folder)).lexically_normal();
    const bool is_taken = std::any_of(
        sweep.configurations.begin(), sweep.configurations.end(),
        [&](const SweepConfiguration& other) { return other.name == configuration.name; });
    if (is_taken)
      throw InputError(folder.string(), "has the name of another configuration of the sweep");
    sweep.configurations.push_back(std::move(configuration));
  }
}

void prepare_submissions(std::span<const fs::path> submissions, const fs::path& folder) {
  std::optional<SweepFolderLock> lock;
  if (!submissions.empty() && fs::exists(folder)) lock.emplace(folder);
  for (const fs::path& submission : submissions) {
    const AdapterConfig adapter = read_submission(submission);
    if (adapter.prepare.empty()) continue;
    const std::string name = folder_name(submission);
    ExternalCall call;
    call.words = shell_words(adapter.prepare);
    call.working_folder = fs::absolute(submission);
    call.log = call.working_folder / "prepare.log";
    call.timeout_s = kPrepareTimeoutS;
    std::error_code none;
    fs::remove(call.log, none);
    Progress progress("preparing " + name, 1, "commands");
    const ExternalEnd end = run_external_program(call);
    if (end.timed_out || end.end.exit_code != 0)
      throw InputError(adapter_of(submission).string(),
                       fmt::format("its command 'prepare' {}; {}: {}",
                                   end.timed_out ? "timed out" : "failed with " + end.end.text(),
                                   call.log.string(), log_tail(call.log)));
    progress.add(1);
  }
}

std::string describe_submissions(std::span<const fs::path> submissions, const SweepConfig& sweep,
                                 const fs::path& folder) {
  if (submissions.empty()) return "";
  const SweepPlan plan = plan_sweep(sweep, folder);
  std::string text;
  for (const fs::path& submission : submissions) {
    const AdapterConfig adapter = read_submission(submission);
    text += fmt::format("{}: licence {}{}{}\n", adapter.name, adapter.licence,
                        adapter.link.empty() ? "" : ", " + adapter.link,
                        time_text(adapter, measured_s(plan, folder_name(submission))));
  }
  return text;
}

}  // namespace saccade
