#include <fmt/core.h>

#include <filesystem>
#include <memory>

#include "apps/common_options.h"
#include "apps/option_checks.h"
#include "apps/verbs.h"
#include "eval/picture/render.h"

namespace saccade {
namespace {

struct RenderVerbOptions {
  std::filesystem::path path;
  std::filesystem::path output;
  bool light = false;
  RenderOptions render;
  CommonOptions common;
};

void render_path(RenderVerbOptions options) {
  options.common.apply();
  options.render.dark = !options.light;
  render(options.path, options.output, options.render);
  if (!options.common.quiet) fmt::print("wrote {}\n", options.output.string());
}

}  // namespace

void add_render_verb(CLI::App& command) {
  const auto options = std::make_shared<RenderVerbOptions>();
  RenderOptions& render = options->render;
  CLI::App* verb = command.add_subcommand(
      "render", "Draw a dataset (events, frames, depth) or a run (the map over its events)");
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
  verb->add_option("--fps", render.fps, "Frame rate of a video")
      ->check(number_between(1, 240))
      ->capture_default_str();
  verb->add_option("--slow-motion", render.slow_motion, "Seconds of video per second recorded")
      ->check(positive_number())
      ->capture_default_str();
  verb->add_flag("--light", options->light, "On a light background");
  add_common_options(*verb, options->common);
  verb->footer(
      "Examples:\n"
      "  saccade render data/walls -o walls.png\n"
      "  saccade render runs/walls -o walls.mp4 --slow-motion 5");
  verb->callback([options] { render_path(*options); });
}

}  // namespace saccade
