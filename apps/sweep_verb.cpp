#include <fmt/core.h>

#include <filesystem>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "apps/common_options.h"
#include "apps/option_checks.h"
#include "apps/verbs.h"
#include "core/error.h"
#include "core/io/files/atomic_file.h"
#include "core/process/progress.h"
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
  std::filesystem::path jobs_json;
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
  fmt::print("{}: {} jobs done, {} done before, {} failed\n", options.output.string(), summary.done,
             summary.skipped, summary.failed);
  fmt::print("wrote {} and {}\n", (options.output / table).string() + "." + page,
             (options.output / table).string() + ".csv");
}

void sweep(const SweepVerbOptions& options) {
  set_progress_quiet(options.quiet);
  SweepConfig config = load(options);
  const std::unique_ptr<Launcher> launcher =
      make_launcher(options.launcher, {{}, options.output, options.slurm});
  if (options.print_config) {
    fmt::print("{}", config::print_documented(config));
    return;
  }
  for (const std::string& message : leave_out_absent(config)) fmt::print(stderr, "{}\n", message);
  if (config.datasets.empty() && !config.generate) {
    fmt::print("{}: none of its datasets is here, nothing is run\n", options.file);
    return;
  }
  if (options.output.empty()) throw InputError("-o", "name the folder of the sweep: -o DIR");
  if (options.status) {
    fmt::print("{}", sweep_status(config, options.output));
    return;
  }
  if (!options.jobs_json.empty()) {
    write_atomically(options.jobs_json, sweep_jobs_json(config, options.output));
    return;
  }
  if (options.dry_run) {
    fmt::print("{}", config.generate ? estimate_generation(config, options.output, options.jobs)
                                     : describe_sweep(config, options.output));
    return;
  }
  const SweepSummary summary = run_sweep(config, options.output, *launcher, options.jobs);
  if (summary.interrupted)
    throw std::runtime_error("interrupted; the same command goes on from here");
  if (!options.quiet) show(options, summary, config.generate && config.configurations.empty());
  if (summary.failed > 0)
    throw std::runtime_error(fmt::format("{} {} failed; what they printed is in {}/NAME/log.txt",
                                         summary.failed, summary.failed == 1 ? "job" : "jobs",
                                         (options.output / "jobs").string()));
  if (summary.missed > 0)
    throw std::runtime_error(fmt::format("{} expected {} missed: {}", summary.missed,
                                         summary.missed == 1 ? "metric was" : "metrics were",
                                         (options.output / "sweep.md").string()));
}

void add_sweep_options(CLI::App& verb, SweepVerbOptions& options) {
  verb.add_option("--launcher", options.launcher, "Where the jobs run: local or slurm.")
      ->capture_default_str();
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
  verb.add_option(
          "-j,--jobs", options.jobs,
          "Number of jobs at a time (default: as many as the cores allow; on Slurm, as many as it "
          "accepts). Speeds are comparable only with 1; `timing: true` in the file requires it.")
      ->type_name("N")
      ->check(whole_number(1, 4096));
  verb.add_flag("--dry-run", options.dry_run,
                "Print the command lines and what would be skipped; for a sweep that generates "
                "datasets, estimate events, bytes and time from a short calibration run.");
  verb.add_flag("--status", options.status,
                "Print how many jobs are done, running, failed and waiting, also while another "
                "program runs them, and stop.");
  verb.add_option("--jobs-json", options.jobs_json,
                  "Write the jobs with their commands and what each needs as JSON, for another "
                  "workflow manager, and stop.")
      ->type_name("FILE");
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
