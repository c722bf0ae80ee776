#include <fmt/core.h>

#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include "apps/common_options.h"
#include "apps/option_checks.h"
#include "apps/verbs.h"
#include "core/error.h"
#include "core/process/progress.h"
#include "eval/evaluate.h"
#include "eval/evaluate_events.h"
#include "eval/metrics/trajectory/align.h"
#include "eval/store/result_store.h"

namespace saccade {
namespace {

struct EvalOptions {
  std::filesystem::path run;
  std::filesystem::path trajectory;
  std::filesystem::path depth;
  std::filesystem::path cloud;
  std::filesystem::path image;
  EventsToCompare events;
  std::optional<double> at_s;
  EvaluateOptions evaluate;
  std::optional<std::filesystem::path> output;
  CommonOptions common;
};

void show(const EvalOptions& options, const Metrics& metrics, const std::string& title) {
  if (!options.common.quiet) fmt::print("{}", format_metrics(metrics, title));
}

/// What the option names was found by any program.
bool is_foreign(const EvalOptions& options) {
  return !options.trajectory.empty() || !options.depth.empty() || !options.cloud.empty() ||
         !options.image.empty() || !options.events.events.empty();
}

void compare_events(const EvalOptions& options) {
  if (options.events.truth.empty())
    throw InputError("--against", "name what the events are scored against: --against DATASET");
  show(options, evaluate_events(options.events, options.output),
       fmt::format("{} against {}", options.events.events.string(), options.events.truth.string()));
  if (options.output && !options.common.quiet) fmt::print("wrote {}\n", options.output->string());
}

void evaluate_foreign_depth(const EvalOptions& options) {
  ExternalDepth depth;
  depth.is_cloud = options.depth.empty();
  depth.file = depth.is_cloud ? options.cloud : options.depth;
  depth.at_s = options.at_s;
  show(options, evaluate_depth(depth, *options.evaluate.dataset, options.output),
       depth.file.string());
}

void evaluate_foreign(const EvalOptions& options) {
  if (!options.events.events.empty()) return compare_events(options);
  if (!options.evaluate.dataset)
    throw InputError("--data", "it is scored against a dataset: --data DATASET");
  if (!options.image.empty())
    return show(
        options,
        evaluate_image(options.image, options.at_s, *options.evaluate.dataset, options.output),
        options.image.string());
  if (options.trajectory.empty()) return evaluate_foreign_depth(options);
  const Metrics metrics = evaluate_trajectory(options.trajectory, *options.evaluate.dataset,
                                              options.output, options.evaluate.mean_depth_m);
  show(options, metrics, options.trajectory.string());
}

/// Options that make sense beside --events alone, or not beside it.
void check_comparison(const EvalOptions& options) {
  const RecordingPart& part = options.events.part;
  const bool compares = !options.events.events.empty();
  if (!compares && !options.events.truth.empty())
    throw InputError("--against", "is what --events are scored against; add --events RECORDING");
  if (!compares && (part.start_s || part.duration_s))
    throw InputError(part.start_s ? "--start-s" : "--duration-s",
                     "cuts a part of --events; a run keeps the window that it was made with");
  if (compares && options.at_s)
    throw InputError("--at-s", "is the time of a view; --start-s and --duration-s cut --events");
  if (compares && options.evaluate.dataset)
    throw InputError("--data", "--events are scored against a recording: --against RECORDING");
}

/// A run that found its start by itself has a world of its own.
void say_whose_frame(const std::filesystem::path& run, const Metrics& metrics) {
  const std::optional<double> freedoms = metrics.get("trajectory.aligned_freedoms");
  if (!freedoms) return;
  const Alignment freedom = alignment_of(*freedoms);
  show_notice(
      fmt::format("{}: no pose was given at its start, so that its world has {} of its own: errors "
                  "are those {}",
                  run.string(),
                  freedom == Alignment::kSim3 ? "an origin, an orientation and a scale"
                                              : "an origin and a heading",
                  alignment_text(freedom)));
}

void evaluate(const EvalOptions& options) {
  options.common.apply();
  const int named =
      static_cast<int>(!options.run.empty()) + static_cast<int>(!options.trajectory.empty()) +
      static_cast<int>(!options.depth.empty()) + static_cast<int>(!options.cloud.empty()) +
      static_cast<int>(!options.image.empty()) + static_cast<int>(!options.events.events.empty());
  if (named != 1)
    throw InputError(
        "eval", "name one of: a run folder, --trajectory, --depth, --cloud, --image, --events");
  check_comparison(options);
  if (options.evaluate.refined && options.run.empty())
    throw InputError("--refined", "is compared with a run folder");
  if (is_foreign(options)) return evaluate_foreign(options);
  if (options.output)
    throw InputError(
        "-o", "the scores of a run go to RUN/metrics.json; -o is for other programs' results");
  const Metrics metrics = evaluate_run(options.run, options.evaluate);
  keep_result(options.run);
  show(options, metrics, options.run.string());
  say_whose_frame(options.run, metrics);
}

}  // namespace

void add_eval_verb(CLI::App& command) {
  const auto options = std::make_shared<EvalOptions>();
  CLI::App* verb = command.add_subcommand(
      "eval", "Score a run, or the result of any program, against ground truth.");
  verb->add_option("RUN", options->run,
                   "Run folder; its metrics.json is written, and results.sqlite beside it.");
  verb->add_option("--trajectory", options->trajectory,
                   "Trajectory of any program (TUM: t tx ty tz qx qy qz qw).");
  verb->add_option("--depth", options->depth,
                   "Depth map of any program (EXR: z in metres, 0 is unknown, undistorted), or a "
                   "folder with depth maps and views.yaml.");
  verb->add_option("--cloud", options->cloud, "Point cloud of any program (PLY, world frame).");
  verb->add_option("--image", options->image,
                   "Image of any program (EXR: log intensity, or an 8-bit picture; undistorted), "
                   "or a folder with images and views.yaml.");
  verb->add_option("--events", options->events.events,
                   "Events of any program or sensor, a dataset folder or an event file, to score "
                   "against those of --against.");
  verb->add_option("--against", options->events.truth,
                   "Recording whose events are taken as the truth for --events.");
  verb->add_option("--start-s", options->events.part.start_s,
                   "Begin of the part of both recordings that --events compares (default: all).")
      ->check(number_between(-kLongest_s, kLongest_s));
  verb->add_option("--duration-s", options->events.part.duration_s,
                   "Length of the part that --events compares.")
      ->check(number_between(1e-9, kLongest_s));
  verb->add_option("--at-s", options->at_s,
                   "Time of the view of --image, --depth or --cloud in seconds (default for "
                   "--cloud: the time of the first depth map).")
      ->check(finite_number());
  verb->add_option("--data", options->evaluate.dataset,
                   "Dataset with the ground truth (default: the dataset that the run used).");
  verb->add_option("--mean-depth-m", options->evaluate.mean_depth_m,
                   "Mean scene depth in metres, for dt_rel, where the dataset states none.")
      ->check(positive_number());
  verb->add_option("--refined", options->evaluate.refined,
                   "Run of refine over the same dataset; refined_ratio.* is the error of the run "
                   "divided by that of the refined run.")
      ->type_name("RUN");
  verb->add_option("-o,--output", options->output,
                   "JSON file for the scores of another program's result; with --events a folder "
                   "for metrics.json and pixels.png.");
  add_common_options(*verb, options->common);
  verb->footer(
      "Examples:\n"
      "  saccade eval runs/walls\n"
      "  saccade eval runs/walls --refined runs/walls_refined\n"
      "  saccade eval --trajectory mine.txt --data data/walls -o mine.json\n"
      "  saccade eval --depth mine.exr --at-s 0.5 --data data/walls\n"
      "  saccade eval --image mine.png --at-s 0.5 --data data/walls\n"
      "  saccade eval --events mine.h5 --against data/walls -o scores");
  verb->callback([options] { evaluate(*options); });
}

}  // namespace saccade
