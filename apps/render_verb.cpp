#include <fmt/core.h>

#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include "apps/common_options.h"
#include "apps/option_checks.h"
#include "apps/pose_option.h"
#include "apps/scene_preview.h"
#include "apps/verbs.h"
#include "core/error.h"
#include "eval/picture/figure/run_figures.h"
#include "eval/picture/render.h"

namespace saccade {
namespace {

struct RenderVerbOptions {
  std::filesystem::path path;
  std::filesystem::path output;
  bool light = false;
  RenderOptions render;
  OverlayOptions overlay;
  std::optional<std::filesystem::path> picture;
  std::optional<std::string> overlay_pose;
  CommonOptions common;
};

bool is_configuration(const std::filesystem::path& path) {
  return path.extension() == ".yaml" && !std::filesystem::is_directory(path);
}

/// "name: what it shows." of every figure.
std::string figure_help() {
  std::string text = "Draw a figure of a run in place of its contact sheet.";
  for (const RunFigure& figure : run_figures())
    text += fmt::format(" {}: {}", figure.name, figure.help);
  return text;
}

void render_path(RenderVerbOptions options) {
  options.common.apply();
  if (is_configuration(options.path))
    return render_preview(options.path.string(), options.output, options.light, options.common);
  options.render.dark = !options.light;
  if (options.overlay_pose)
    options.overlay.world_from_picture = parse_pose(*options.overlay_pose, "--overlay-pose");
  if (options.picture) {
    if (options.picture->empty())
      throw InputError("--overlay", "names no picture; docs/images/logo.png is one");
    options.overlay.picture = *options.picture;
    options.render.overlay = options.overlay;
  }
  render(options.path, options.output, options.render);
  if (!options.common.quiet) fmt::print("wrote {}\n", options.output.string());
}

void add_overlay_options(CLI::App& verb, RenderVerbOptions& options) {
  OverlayOptions& overlay = options.overlay;
  CLI::Option* const picture =
      verb.add_option("--overlay", options.picture,
                      "Picture that is drawn into the world, over events and frames.")
          ->type_name("PICTURE");
  const auto add = [&](CLI::Option* option) { return option->needs(picture); };
  add(verb.add_option("--overlay-pose", options.overlay_pose,
                      "Pose world from picture (default: just in front of the scene)."))
      ->type_name("\"x y z qx qy qz qw\"");
  add(verb.add_option("--overlay-width", overlay.width_m,
                      "Width of the picture in metres (default: a quarter of the view)."))
      ->check(positive_number());
  add(verb.add_option("--overlay-at-s", overlay.at_s,
                      "Time in seconds of the camera pose in front of which the picture is placed "
                      "by default (default: the first pose)."))
      ->check(finite_number());
  add(verb.add_flag(
      "--overlay-truth", overlay.truth,
      "Also draw the outline of the picture as seen from the ground-truth pose of a run."));
  add(verb.add_flag(
      "--overlay-on-top", overlay.on_top,
      "Draw the picture over everything, even where the depth maps say that it is occluded."));
}

}  // namespace

void add_render_verb(CLI::App& command) {
  const auto options = std::make_shared<RenderVerbOptions>();
  RenderOptions& render = options->render;
  CLI::App* verb =
      command.add_subcommand("render",
                             "Draw a dataset (events, frames, depth), a run (the map over its "
                             "events, keyframes, views, or what it stabilized), or what a "
                             "simulation would see: views along its path and a plan.");
  verb->add_option("PATH", options->path,
                   "Dataset folder, run folder, or simulation configuration (YAML).")
      ->required();
  verb->add_option("-o,--output", options->output,
                   "Picture (.png) or video (.mp4, by ffmpeg) to write.")
      ->required()
      ->type_name("FILE");
  verb->add_option("--time", render.time_s,
                   "Draw one moment, in seconds, instead of a contact sheet.")
      ->check(finite_number());
  verb->add_option("--start-s", render.start_s, "Start of the part that is drawn, in seconds.")
      ->check(finite_number());
  verb->add_option("--duration-s", render.duration_s,
                   "Length of the part that is drawn, in seconds.")
      ->check(positive_number());
  verb->add_option("--figure", render.figure, figure_help())->type_name("NAME");
  verb->add_option("--data", render.dataset,
                   "Dataset of a run, instead of the one that the run names.");
  verb->add_option("--events", render.events,
                   "Number of events per picture (default: 15 % of the pixels).")
      ->type_name("N")
      ->check(whole_number(1));
  verb->add_option("--upscale", render.upscale, "Number of screen pixels per sensor pixel.")
      ->check(whole_number(1, 8))
      ->capture_default_str();
  verb->add_option(
          "--fps", render.fps,
          "Frame rate of a video in Hz (default: 30; 3 for views and for the growth of a map).")
      ->check(number_between(1, 240));
  verb->add_option("--slow-motion", render.slow_motion, "Seconds of video per recorded second.")
      ->check(positive_number())
      ->capture_default_str();
  verb->add_flag("--light", options->light, "Draw on a light background.");
  add_overlay_options(*verb, *options);
  add_override_option(*verb, options->common);
  add_common_options(*verb, options->common);
  verb->footer(
      "Examples:\n"
      "  saccade render configs/simulation/walls.yaml -o preview.png\n"
      "  saccade render data/walls -o walls.png\n"
      "  saccade render runs/walls -o walls.mp4 --slow-motion 5\n"
      "  saccade render runs/dunes -o odometry.mp4 --slow-motion 5\n"
      "  saccade render runs/walls --figure trajectory -o walls_errors.png\n"
      "  saccade render runs/walls_depth -o walls_depth.png\n"
      "  saccade render runs/walls_image -o growth.mp4 --fps 10\n"
      "  saccade render runs/leaves -o leaves.mp4 --overlay docs/images/logo.png --overlay-truth");
  verb->callback([options] { render_path(*options); });
}

}  // namespace saccade
