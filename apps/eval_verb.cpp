#include <fmt/core.h>

#include <filesystem>
#include <memory>
#include <optional>

#include "apps/common_options.h"
#include "apps/option_checks.h"
#include "apps/verbs.h"
#include "core/error.h"
#include "eval/evaluate.h"

namespace saccade {
namespace {

struct EvalOptions {
  std::filesystem::path run;
  std::filesystem::path trajectory;
  EvaluateOptions evaluate;
  std::optional<std::filesystem::path> output;
  CommonOptions common;
};

void show(const EvalOptions& options, const Metrics& metrics, const std::string& title) {
  if (!options.common.quiet) fmt::print("{}", format_metrics(metrics, title));
}

void evaluate_foreign(const EvalOptions& options) {
  if (!options.evaluate.dataset)
    throw InputError("--data", "a trajectory is scored against a dataset: --data DATASET");
  const Metrics metrics = evaluate_trajectory(options.trajectory, *options.evaluate.dataset,
                                              options.output, options.evaluate.mean_depth_m);
  show(options, metrics, options.trajectory.string());
}

void evaluate(const EvalOptions& options) {
  options.common.apply();
  if (options.run.empty() == options.trajectory.empty())
    throw InputError("eval", "name either a run folder or --trajectory EST.txt");
  if (!options.trajectory.empty()) return evaluate_foreign(options);
  if (options.output)
    throw InputError("-o", "the scores of a run go to RUN/metrics.json; -o is for --trajectory");
  show(options, evaluate_run(options.run, options.evaluate), options.run.string());
}

}  // namespace

void add_eval_verb(CLI::App& command) {
  const auto options = std::make_shared<EvalOptions>();
  CLI::App* verb = command.add_subcommand(
      "eval", "Score a run, or the trajectory of any program, against ground truth");
  verb->add_option("RUN", options->run, "Run folder; its metrics.json is written");
  verb->add_option("--trajectory", options->trajectory,
                   "Trajectory of any program (TUM: t tx ty tz qx qy qz qw)");
  verb->add_option("--data", options->evaluate.dataset,
                   "Dataset to score against (default: the one the run used)");
  verb->add_option("--mean-depth-m", options->evaluate.mean_depth_m,
                   "d of dt_rel, where the dataset states none")
      ->check(positive_number());
  verb->add_option("-o,--output", options->output, "Where the scores of --trajectory go (JSON)");
  add_common_options(*verb, options->common);
  verb->footer(
      "Examples:\n"
      "  saccade eval runs/walls\n"
      "  saccade eval --trajectory mine.txt --data data/walls -o mine.json");
  verb->callback([options] { evaluate(*options); });
}

}  // namespace saccade
