#include <fmt/core.h>

#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include "apps/common_options.h"
#include "apps/option_checks.h"
#include "apps/pose_option.h"
#include "apps/verbs.h"
#include "core/error.h"
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

void render_path(RenderVerbOptions options) {
  options.common.apply();
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
                      "Picture that hangs in the world, over events and frames")
          ->type_name("PICTURE");
  const auto add = [&](CLI::Option* option) { return option->needs(picture); };
  add(verb.add_option("--overlay-pose", options.overlay_pose,
                      "World from picture (default: just in front of the scene)"))
      ->type_name("\"x y z qx qy qz qw\"");
  add(verb.add_option("--overlay-width", overlay.width_m,
                      "Its width [m] (default: a quarter of the view)"))
      ->check(positive_number());
  add(verb.add_option("--overlay-at-s", overlay.at_s,
                      "The camera that it is in front of by default [s] (default: the first)"))
      ->check(finite_number());
  add(verb.add_flag("--overlay-truth", overlay.truth,
                    "Its outline where the true pose of a run sees it"));
  add(verb.add_flag("--overlay-on-top", overlay.on_top,
                    "Not hidden by what the depth maps see before it"));
}

}  // namespace

void add_render_verb(CLI::App& command) {
  const auto options = std::make_shared<RenderVerbOptions>();
  RenderOptions& render = options->render;
  CLI::App* verb = command.add_subcommand("render",
                                          "Draw a dataset (events, frames, depth) or a run (the "
                                          "map over its events, keyframes, views, or what "
                                          "it stabilized)");
  verb->add_option("PATH", options->path, "Dataset or run folder")->required();
  verb->add_option("-o,--output", options->output, "Picture (.png) or video (.mp4, by ffmpeg)")
      ->required()
      ->type_name("FILE");
  verb->add_option("--time", render.time_s, "One moment instead of a contact sheet [s]")
      ->check(finite_number());
  verb->add_option("--start-s", render.start_s, "Begin of the part that is shown [s]")
      ->check(finite_number());
  verb->add_option("--duration-s", render.duration_s, "Length of the part that is shown [s]")
      ->check(positive_number());
  verb->add_option("--data", render.dataset, "Dataset of a run, instead of the one it names");
  verb->add_option("--events", render.events, "Events per picture (default: 15 % of the pixels)")
      ->type_name("N")
      ->check(whole_number(1));
  verb->add_option("--upscale", render.upscale, "Screen pixels per sensor pixel")
      ->check(whole_number(1, 8))
      ->capture_default_str();
  verb->add_option("--fps", render.fps,
                   "Frame rate of a video (default: 30; of views and growth 3)")
      ->check(number_between(1, 240));
  verb->add_option("--slow-motion", render.slow_motion, "Seconds of video per second recorded")
      ->check(positive_number())
      ->capture_default_str();
  verb->add_flag("--light", options->light, "On a light background");
  add_overlay_options(*verb, *options);
  add_common_options(*verb, options->common);
  verb->footer(
      "Examples:\n"
      "  saccade render data/walls -o walls.png\n"
      "  saccade render runs/walls -o walls.mp4 --slow-motion 5\n"
      "  saccade render runs/dunes -o odometry.mp4 --slow-motion 5\n"
      "  saccade render runs/walls_depth -o walls_depth.png\n"
      "  saccade render runs/walls_image -o growth.mp4 --fps 10\n"
      "  saccade render runs/leaves -o leaves.mp4 --overlay docs/images/logo.png --overlay-truth");
  verb->callback([options] { render_path(*options); });
}

}  // namespace saccade
