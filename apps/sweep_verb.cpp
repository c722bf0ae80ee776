#include <fmt/core.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "apps/common_options.h"
#include "apps/option_checks.h"
#include "apps/submission.h"
#include "apps/verbs.h"
#include "core/error.h"
#include "core/io/files/atomic_file.h"
#include "core/process/progress.h"
#include "eval/sweep/generated_datasets.h"
#include "eval/sweep/merge.h"
#include "eval/sweep/plan/sweep_config.h"
#include "eval/sweep/status.h"
#include "eval/sweep/sweep.h"

namespace saccade {
namespace {

struct SweepVerbOptions {
  std::string file;
  std::filesystem::path output;
  std::string launcher = "local";
  SlurmOptions slurm;
  std::vector<std::string> overrides;
  std::vector<std::string> seeds;
  int threads = 0;  ///< 0: as the file states it
  int jobs = 0;     ///< at a time; 0: one per core
  bool dry_run = false;
  bool status = false;
  bool follow = false;
  std::filesystem::path jobs_json;
  std::vector<std::filesystem::path> merge;
  std::filesystem::path pack;
  bool clean = false;
  std::vector<std::filesystem::path> submissions;
  bool print_config = false;
  bool quiet = false;
};

SweepConfig load(const SweepVerbOptions& options) {
  std::vector<std::string> overrides = options.overrides;
  std::string seeds;
  for (const std::string& seed : options.seeds) seeds += (seeds.empty() ? "" : ", ") + seed;
  if (!seeds.empty()) overrides.push_back("seeds=[" + seeds + "]");
  if (options.threads > 0) overrides.push_back(fmt::format("threads={}", options.threads));
  return config::read<SweepConfig>(config::load(options.file, overrides));
}

void show(const SweepVerbOptions& options, const SweepSummary& summary, bool generates) {
  const char* table = generates ? "manifest" : "sweep";
  const char* page = generates ? "json" : "md";
  fmt::print("{}: {} jobs done, {} done before, {} failed{}\n", options.output.string(),
             summary.done, summary.skipped, summary.failed,
             summary.stopped > 0 ? fmt::format(", {} stopped early", summary.stopped) : "");
  fmt::print("wrote {} and {}\n", (options.output / table).string() + "." + page,
             (options.output / table).string() + ".csv");
}

/// Once, or until nothing is left to do. A terminal shows the newest in the place of the last.
void show_status(const SweepConfig& config, const SweepVerbOptions& options) {
  constexpr std::chrono::seconds kPeriod{2};
  const bool overwrites = options.follow && isatty(STDOUT_FILENO) != 0;
  for (;;) {
    const SweepStatus status = sweep_status(config, options.output);
    if (overwrites) fmt::print("\033[H\033[2J");
    fmt::print("{}", status_text(status));
    std::fflush(stdout);
    if (!options.follow || status.has_ended()) return;
    std::this_thread::sleep_for(kPeriod);
  }
}

void clean(const SweepConfig& config, const SweepVerbOptions& options) {
  const CleanSummary summary = clean_generated(config, options.output);
  for (const std::filesystem::path& folder : summary.removed)
    fmt::print("removed {}\n", folder.string());
  fmt::print("{} datasets removed, {:.2f} GB\n", summary.removed.size(),
             static_cast<double>(summary.bytes) / 1e9);
}

void pack(const SweepConfig& config, const SweepVerbOptions& options) {
  const PackSummary summary = pack_generated(config, options.output, options.pack);
  fmt::print("{}: {} datasets in {} archives, {} of them up to date\n", options.pack.string(),
             summary.datasets, summary.archives, summary.up_to_date);
}

void merge(const SweepConfig& config, const SweepVerbOptions& options) {
  constexpr std::size_t kShown = 5;
  const MergeSummary summary = merge_sweeps(config, options.output, options.merge);
  for (std::size_t i = 0; i < std::min(kShown, summary.refused.size()); ++i)
    fmt::print(stderr, "not taken: {}: {}\n", summary.refused[i].first, summary.refused[i].second);
  if (summary.refused.size() > kShown)
    fmt::print(stderr, "and {} more were not taken\n", summary.refused.size() - kShown);
  if (!options.quiet)
    fmt::print("{}: {} jobs taken, {} were there\n", options.output.string(), summary.taken,
               summary.there);
}

void sweep(SweepVerbOptions options) {
  set_progress_quiet(options.quiet);
  // Nodes do not know the working directory.
  if (!options.slurm.container.empty())
    options.slurm.container = std::filesystem::canonical(options.slurm.container);
  SweepConfig config = load(options);
  const std::unique_ptr<Launcher> launcher =
      make_launcher(options.launcher, {{}, options.output, options.slurm, true});
  if (options.print_config) {
    fmt::print("{}", config::print_documented(config));
    return;
  }
  add_submissions(config, options.submissions);
  for (const std::string& message : leave_out_absent(config)) fmt::print(stderr, "{}\n", message);
  if (config.datasets.empty() && !config.generate) {
    fmt::print("{}: none of its datasets is here, nothing is run\n", options.file);
    return;
  }
  if (options.output.empty()) throw InputError("-o", "name the folder of the sweep: -o DIR");
  if (options.status) {
    show_status(config, options);
    return;
  }
  if (!options.jobs_json.empty()) {
    write_atomically(options.jobs_json, sweep_jobs_json(config, options.output));
    return;
  }
  if (options.clean || !options.pack.empty()) {
    if (!config.generate)
      throw InputError(options.clean ? "--clean" : "--pack",
                       "is for sweeps that generate datasets");
    if (options.clean) clean(config, options);
    if (!options.pack.empty()) pack(config, options);
    return;
  }
  if (options.dry_run) {
    fmt::print("{}", config.generate ? estimate_generation(config, options.output, options.jobs)
                                     : describe_sweep(config, options.output));
    return;
  }
  prepare_submissions(options.submissions, options.output);
  if (!options.merge.empty()) merge(config, options);
  const SweepSummary summary = run_sweep(config, options.output, *launcher, options.jobs);
  if (summary.interrupted)
    throw std::runtime_error("interrupted; the same command goes on from here");
  if (!options.quiet) show(options, summary, config.generate && config.configurations.empty());
  fmt::print(
      "{}", options.quiet ? "" : describe_submissions(options.submissions, config, options.output));
  if (summary.failed > 0)
    throw std::runtime_error(fmt::format("{} {} failed; what they printed is in {}/NAME/log.txt",
                                         summary.failed, summary.failed == 1 ? "job" : "jobs",
                                         (options.output / "jobs").string()));
  if (summary.missed > 0)
    throw std::runtime_error(fmt::format("{} expected {} missed: {}", summary.missed,
                                         summary.missed == 1 ? "metric was" : "metrics were",
                                         (options.output / "sweep.md").string()));
}

void add_slurm_options(CLI::App& verb, SweepVerbOptions& options) {
  verb.add_option("--slurm-option", options.slurm.options,
                  "Option for sbatch, e.g. --slurm-option=--partition=long (repeatable).")
      ->type_name("OPTION")
      ->take_all()
      ->allow_extra_args(false)
      ->check([](const std::string& option) {
        return option.starts_with('-') ? "" : "must be an option of sbatch, such as --account=NAME";
      });
  verb.add_option("--slurm-jobs-per-task", options.slurm.jobs_per_task,
                  "Jobs that one task of a Slurm array runs one after another. More reduce Slurm's "
                  "overhead for jobs of less than a second, and the parallelism.")
      ->type_name("N")
      ->capture_default_str()
      ->check(whole_number(1, 10000));
  verb.add_option("--slurm-minutes", options.slurm.request.minutes,
                  "Time limit of a job on Slurm. One that exceeds it is submitted again with twice "
                  "the time, up to three times in all.")
      ->type_name("MINUTES")
      ->check(CLI::Range(0.1, 1e6));
  verb.add_option("--slurm-memory-mb", options.slurm.request.memory_mb,
                  "Memory of a task on Slurm; the same holds for it.")
      ->type_name("MB")
      ->check(CLI::Range(1.0, 1e8));
  verb.add_flag("--slurm-pilot", options.slurm.pilot,
                "Run the first job of every kind alone, and request time and memory for the others "
                "by what it took, with a margin.");
  verb.add_option("--slurm-container", options.slurm.container,
                  "Image of Apptainer in which the jobs run on the nodes, with saccade on its "
                  "search path. Folders other than the sweep's are shown to it by APPTAINER_BIND.")
      ->type_name("IMAGE")
      ->check(CLI::ExistingFile);
}

/// What a sweep does in place of running its jobs, or before.
void add_sweep_modes(CLI::App& verb, SweepVerbOptions& options) {
  CLI::Option* dry_run =
      verb.add_flag("--dry-run", options.dry_run,
                    "Print the command lines and what would be skipped; for a sweep that generates "
                    "datasets, estimate events, bytes and time from a short calibration run.");
  CLI::Option* status =
      verb.add_flag("--status", options.status,
                    "Print how many jobs are done, running, failed and waiting, also while another "
                    "program runs them, and stop.");
  verb.add_flag("--follow", options.follow,
                "With --status: print it again every two seconds until the sweep has ended.")
      ->needs(status);
  CLI::Option* json =
      verb.add_option("--jobs-json", options.jobs_json,
                      "Write the jobs with their commands and what each needs as JSON, for another "
                      "workflow manager, and stop.")
          ->type_name("FILE");
  CLI::Option* merge =
      verb.add_option(
              "--merge", options.merge,
              "Folders of the same sweep, as from other clusters: take what they have done, "
              "then go on.")
          ->type_name("DIR");
  CLI::Option* clean =
      verb.add_flag("--clean", options.clean,
                    "Remove generated datasets that the sweep does not plan any more, and stop.");
  CLI::Option* pack =
      verb.add_option("--pack", options.pack,
                      "Write the generated datasets as archives, one for each split and shard, and "
                      "stop.")
          ->type_name("DIR");
  // Each does one thing and stops, but for --merge, which goes on.
  const std::vector<CLI::Option*> modes{dry_run, status, json, merge, clean, pack};
  for (std::size_t i = 0; i < modes.size(); ++i)
    for (std::size_t k = 0; k < i; ++k) modes[i]->excludes(modes[k]);
}

void add_sweep_options(CLI::App& verb, SweepVerbOptions& options) {
  verb.add_option("--launcher", options.launcher, "Where the jobs run: local or slurm.")
      ->capture_default_str();
  add_slurm_options(verb, options);
  verb.add_option(
          "-j,--jobs", options.jobs,
          "Number of jobs at a time (default: as many as the cores allow; on Slurm, as many as it "
          "accepts). Speeds are comparable only with 1; `timing: true` in the file requires it.")
      ->type_name("N")
      ->check(whole_number(1, 4096));
  add_sweep_modes(verb, options);
  verb.add_option(
          "--submission", options.submissions,
          "Also run the method in this folder, which holds an adapter.yaml with its licence "
          "and class (repeatable); sweep.md ranks it in its class.")
      ->type_name("DIR")
      ->take_all()
      ->allow_extra_args(false);
  verb.add_option("--set", options.overrides,
                  "Override one key of the sweep file, e.g. --set repeat=1 (repeatable).")
      ->type_name("KEY.PATH=VALUE")
      ->take_all()
      ->allow_extra_args(false);
  verb.add_option("--seed", options.seeds, "Seed that replaces the seeds of the file (repeatable).")
      ->type_name("N")
      ->take_all()
      ->allow_extra_args(false)
      ->check(whole_number(0, std::numeric_limits<std::uint64_t>::max()));
  verb.add_option("--threads", options.threads,
                  "Number of threads of one run, in place of the file's.")
      ->type_name("N")
      ->check(whole_number(1, 4096));
  verb.add_flag("--print-config", options.print_config,
                "Print every key with its value, help and range, and stop.");
  verb.add_flag("-q,--quiet", options.quiet, "Print errors only: no progress, no summary.");
}

}  // namespace

void add_sweep_verb(CLI::App& command) {
  const auto options = std::make_shared<SweepVerbOptions>();
  CLI::App* verb = command.add_subcommand(
      "sweep", "Run a grid of configurations x datasets x seeds into one table; resumable.");
  verb->add_option("SWEEP", options->file, "Sweep file (YAML).")->required();
  verb->add_option("-o,--output", options->output, "Folder of the sweep.")->type_name("DIR");
  add_sweep_options(*verb, *options);
  add_reference_option(*verb, "sweep");
  verb->footer(
      "Examples:\n"
      "  saccade sweep configs/sweeps/tracking_samples.yaml -o sweeps/samples\n"
      "  saccade sweep configs/sweeps/tracking_samples.yaml -o sweeps/samples --dry-run\n"
      "  saccade sweep configs/sweeps/tracking_samples.yaml -o sweeps/samples --launcher slurm");
  verb->callback([options] { sweep(*options); });
}

}  // namespace saccade
