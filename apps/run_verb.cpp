#include <fmt/core.h>
#include <unistd.h>

#include <memory>
#include <string>

#include "apps/command_line.h"
#include "apps/common_options.h"
#include "apps/option_checks.h"
#include "apps/reference_page.h"
#include "apps/verbs.h"
#include "core/error.h"
#include "core/process/parallel.h"
#include "estimator/registry.h"

namespace saccade {
namespace {

struct RunVerbOptions {
  std::string module;
  std::string config;
  RunRequest request;
  bool reference = false;
  CommonOptions common;
};

std::string module_list() {
  std::string list;
  for (const Module& module : modules())
    list += fmt::format("{}{}: {}", list.empty() ? "" : "; ", module.name, module.help);
  return list;
}

void show(const std::filesystem::path& output, const RunSummary& summary) {
  const auto events = static_cast<double>(summary.events);
  const double wall_s = summary.wall_s;
  std::string line = fmt::format("{}: {} from {:.3f} M events in {:.3f} s", output.string(),
                                 summary.found, 1e-6 * events, wall_s);
  if (wall_s > 0) line += fmt::format(": {:.3f} M events/s", 1e-6 * events / wall_s);
  if (wall_s > 0 && summary.poses > 0)
    line += fmt::format(", {:.0f} poses/s", static_cast<double>(summary.poses) / wall_s);
  fmt::print("{}\n", line);
}

/// Quiet or not: a run that is lost at its end has poses that nobody should use.
void warn_of_loss(const RunSummary& summary) {
  if (!summary.lost_since_s) return;
  const std::string line = fmt::format(
      "lost since {:.3f} s, up to the end: the poses from then on are probably off by more than "
      "5 % of the depth or 5 degrees",
      *summary.lost_since_s);
  const bool has_colour = isatty(STDERR_FILENO) != 0;
  fmt::print(stderr, "{}{}{}\n", has_colour ? "\033[31m" : "", line, has_colour ? "\033[0m" : "");
}

void run(RunVerbOptions options) {
  options.common.apply();
  const Module& module = find_module(options.module);
  if (options.reference) {
    fmt::print("{}", reference_page(options.module).markdown());
    return;
  }
  options.request.config = options.common.load(options.config);
  if (options.common.print_config) {
    fmt::print("{}", module.print_config(options.request.config));
    return;
  }
  if (options.request.dataset.empty())
    throw InputError("--data", "name the dataset to run on: --data DATASET");
  if (options.request.output.empty())
    throw InputError("-o", "name the run folder to write: -o RUN");
  options.request.threads = thread_count();
  const RunSummary summary = run_module(options.module, options.request);
  if (!options.common.quiet) show(options.request.output, summary);
  warn_of_loss(summary);
}

}  // namespace

void add_run_verb(CLI::App& command) {
  const auto options = std::make_shared<RunVerbOptions>();
  RunRequest& request = options->request;
  CLI::App* verb = command.add_subcommand("run", "Run one estimator over a dataset.");
  verb->add_option("MODULE", options->module, module_list())->required();
  verb->add_option("--data", request.dataset, "Dataset folder, simulated or recorded.")
      ->type_name("DATASET");
  verb->add_option("-o,--output", request.output, "Run folder to write.")->type_name("RUN");
  verb->add_option("-c,--config", options->config,
                   "Configuration of the module (YAML); default: all defaults.")
      ->type_name("CONFIG");
  verb->add_option("--poses-from", request.poses_from,
                   "Run or trajectory file (TUM) whose poses replace the ground truth.")
      ->type_name("RUN");
  verb->add_option("--smooth-poses", request.smooth_poses_s,
                   "Smooths the given poses, such as of motion capture, by a spline with knots "
                   "this many seconds apart; 0.04 suits a hand.")
      ->type_name("SECONDS")
      ->check(positive_number());
  verb->add_option("--depth-from", request.depth_from,
                   "Run whose depth replaces the depth maps of the dataset.")
      ->type_name("RUN");
  verb->add_option(
          "--from", request.from,
          "Run of track, depth or odometry over the same dataset, from which refine starts.")
      ->type_name("RUN");
  verb->add_option("--start-s", request.start_s,
                   "Start of the time window in seconds (default: the first event).")
      ->check(finite_number());
  verb->add_option("--duration-s", request.duration_s,
                   "Length of the time window in seconds (default: to the last event).")
      ->check(positive_number());
  verb->add_option("--repeat", request.repeat, "Number of repetitions, for timing.")
      ->check(whole_number(1, 100000))
      ->capture_default_str();
  verb->add_flag(
      "--reference", options->reference,
      "Print every key of the module's configuration as a page of docs/reference/, and stop.");
  add_config_options(*verb, options->common);
  add_sensor_option(*verb, options->common);
  add_common_options(*verb, options->common);
  verb->footer(
      "Examples:\n"
      "  saccade run track --data data/walls -c configs/tracking/accurate.yaml -o runs/walls\n"
      "  saccade run depth --data data/walls --poses-from runs/walls -c configs/depth/thesis.yaml "
      "-o runs/walls_depth\n"
      "  saccade run depth --data data/handheld --smooth-poses 0.04 -c configs/depth/best.yaml "
      "-o runs/handheld\n"
      "  saccade run reconstruct --data data/walls --depth-from runs/walls_depth "
      "-c configs/reconstruction/best.yaml -o runs/walls_image\n"
      "  saccade run odometry --data data/dunes -c configs/odometry/best.yaml -o runs/dunes\n"
      "  saccade run mosaic --data data/panorama -c configs/mosaic/best.yaml -o runs/mosaic\n"
      "  saccade run rotation --data data/panorama -c configs/rotation/events.yaml -o "
      "runs/rotation\n"
      "  saccade run refine --data data/walls --from runs/walls -o runs/walls_refined\n"
      "  saccade run depth --reference > depth.md");
  verb->callback([options] {
    options->request.command = command_line();
    run(*options);
  });
}

}  // namespace saccade
