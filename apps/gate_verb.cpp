#include <fmt/core.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "apps/common_options.h"
#include "apps/option_checks.h"
#include "apps/verbs.h"
#include "core/error.h"
#include "core/io/files/atomic_file.h"
#include "core/process/progress.h"
#include "eval/gate/baseline_file.h"
#include "eval/gate/comparison.h"
#include "eval/gate/gate_report.h"
#include "eval/gate/paired_benchmark.h"
#include "eval/store/result_store.h"

namespace saccade {
namespace {

struct GateVerbOptions {
  std::vector<std::string> words;  ///< run folders, or with --build the arguments of both
  std::filesystem::path baseline;
  std::vector<std::filesystem::path> builds;
  std::optional<std::filesystem::path> junit;
  std::optional<std::filesystem::path> markdown;
  std::string format = "text";
  GateOptions gate;
  int repeats = 10;
  bool update = false;
  bool all = false;
  bool no_speed = false;
  bool quiet = false;
};

void update(const GateVerbOptions& options, const std::vector<GateRun>& runs) {
  const std::size_t count = update_baseline(options.baseline, runs, options.gate.partial);
  if (!options.quiet)
    fmt::print("wrote {}: {} {}\n", options.baseline.string(), count, count == 1 ? "run" : "runs");
}

/// Annotations on the standard output, and the table at the end of the job's summary where there is
/// one: other steps write to that file, too.
void show_on_github(const GateVerbOptions& options, const GateResult& result) {
  fmt::print("{}", gate_annotations(result, options.baseline.generic_string()));
  const char* summary = std::getenv("GITHUB_STEP_SUMMARY");
  if (summary == nullptr || *summary == '\0') return;
  std::ofstream file(summary, std::ios::app);
  file << gate_markdown(result) << "\n";
  file.close();
  if (!file) throw InputError(summary, "cannot be written (GITHUB_STEP_SUMMARY)");
}

/// Shows and writes the result. A gate that tripped is a failure.
void finish(const GateVerbOptions& options, const GateResult& result) {
  if (!options.quiet) fmt::print("{}", gate_text(result, options.all));
  if (options.format == "github") show_on_github(options, result);
  if (options.junit) write_atomically(*options.junit, gate_junit(result));
  if (options.markdown) write_atomically(*options.markdown, gate_markdown(result));
  if (!result.tripped()) return;
  const std::size_t count = result.count(GateRow::Verdict::kRegressed);
  throw std::runtime_error(fmt::format("the gate tripped: {} {} regressed", count,
                                       count == 1 ? "comparison has" : "comparisons have"));
}

void gate_runs(const GateVerbOptions& options) {
  if (options.baseline.empty())
    throw InputError("--baseline", "name the baseline: --baseline FILE");
  const std::vector<std::filesystem::path> words(options.words.begin(), options.words.end());
  const std::vector<std::filesystem::path> folders = without_store(words);
  if (folders.empty()) throw InputError("gate", "name at least one run folder");
  const std::vector<GateRun> runs = read_gate_runs(folders);
  if (options.update) return update(options, runs);
  finish(options, compare_with_baseline(options.baseline, runs, options.gate));
}

void benchmark_builds(const GateVerbOptions& options) {
  if (options.builds.size() != 2)
    throw InputError("--build", "name two programs: --build A --build B -- ARGUMENTS");
  if (!options.baseline.empty() || options.update)
    throw InputError("--build", "two builds are compared with each other, not with a --baseline");
  if (options.words.empty())
    throw InputError("--build", "say what both are to do: --build A --build B -- ARGUMENTS");
  for (const std::filesystem::path& build : options.builds)
    if (!std::filesystem::exists(build)) throw InputError(build.string(), "does not exist");
  const PairedBenchmark benchmark{options.builds[0], options.builds[1], options.words,
                                  options.repeats};
  Progress progress("running", repetition_order(benchmark.repeats).size(), "runs");
  const PairedTimes times =
      run_paired_benchmark(benchmark, [&](const Repetition&) { progress.add(1); });
  progress.finish();
  finish(options, compare_times(times.first_s, times.second_s, options.gate));
}

void gate(GateVerbOptions& options) {
  set_progress_quiet(options.quiet);
  options.gate.speed = !options.no_speed;
  options.gate.check();
  if (options.builds.empty()) return gate_runs(options);
  options.all = true;  // there is one row
  benchmark_builds(options);
}

void add_rule_options(CLI::App& verb, GateOptions& gate) {
  verb.add_option("--tolerance", gate.tolerance,
                  "Smallest relative change of a metric that counts.")
      ->capture_default_str();
  verb.add_option("--gross", gate.gross,
                  "Smallest relative change that counts in a sequence with fewer than six pairs.")
      ->capture_default_str();
  verb.add_option("--slower", gate.slower, "Smallest factor of the time that counts as slower.")
      ->capture_default_str();
  verb.add_option("--confidence", gate.confidence, "Confidence level of all comparisons together.")
      ->capture_default_str();
  verb.add_option("--resamples", gate.resamples, "Number of bootstrap resamples.")
      ->capture_default_str();
  verb.add_option("--metric", gate.metrics, "Also compare this metric (repeatable).")
      ->type_name("KEY")
      ->take_all()
      ->allow_extra_args(false);
  verb.add_option(
          "--compare", gate.compared,
          "Setting in which the runs differ from the baseline on purpose, a key of --set or "
          "`config` for the file of -c: pairs need not agree in it (repeatable).")
      ->type_name("KEY")
      ->take_all()
      ->allow_extra_args(false);
  verb.add_flag("--partial", gate.partial,
                "Runs of the baseline may be missing; --update then keeps their old values.");
}

void add_gate_options(CLI::App& verb, GateVerbOptions& options) {
  verb.add_option("RUN", options.words,
                  "Scored run folders; with --build, the arguments of both programs after --.");
  verb.add_option("--baseline", options.baseline, "Baseline file that the runs are compared with.")
      ->type_name("FILE");
  verb.add_flag("--update", options.update, "Write the runs to the baseline and compare nothing.");
  verb.add_option(
          "--build", options.builds,
          "Program to time; give it twice to compare the times of both programs by a paired "
          "benchmark.")
      ->type_name("PROGRAM")
      ->take_all()
      ->allow_extra_args(false);
  verb.add_option("--repeats", options.repeats, "Number of timed runs of each build.")
      ->type_name("N")
      ->check(whole_number(2, 100000))
      ->capture_default_str();
  add_rule_options(verb, options.gate);
  verb.add_flag("--no-speed", options.no_speed, "Do not compare the times of the runs.");
  verb.add_option("--format", options.format,
                  "github: also print annotations (::error, ::warning) and append the table to the "
                  "file that GITHUB_STEP_SUMMARY names.")
      ->check(CLI::IsMember({"text", "github"}))
      ->capture_default_str();
  verb.add_option("--junit", options.junit, "Write the result as JUnit XML.")->type_name("FILE");
  verb.add_option("--markdown", options.markdown, "Write the result as Markdown.")
      ->type_name("FILE");
  verb.add_flag("--all", options.all,
                "Also show the comparisons that neither regressed nor improved.");
  verb.add_flag("-q,--quiet", options.quiet, "Print errors only: no progress, no table.");
}

}  // namespace

void add_gate_verb(CLI::App& command) {
  const auto options = std::make_shared<GateVerbOptions>();
  CLI::App* verb = command.add_subcommand(
      "gate", "Compare scored runs with a baseline, or the speed of two builds.");
  add_gate_options(*verb, *options);
  verb->footer(
      "Examples:\n"
      "  saccade gate runs/* --baseline baseline.yaml --update\n"
      "  saccade gate runs/* --baseline baseline.yaml --junit gate.xml --markdown gate.md\n"
      "  saccade gate coarse/* --baseline baseline.yaml --compare edges.samples\n"
      "  saccade gate --build old/saccade --build new/saccade -- \\\n"
      "    run track --data data/walls -c configs/tracking/accurate.yaml -o runs/timed\n\n"
      "Exit codes: 0 nothing regressed, 1 the gate tripped, 2 bad usage or bad input.");
  verb->callback([options] { gate(*options); });
}

}  // namespace saccade
