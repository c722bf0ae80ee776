#include <fmt/core.h>

#include <filesystem>
#include <memory>

#include "apps/verbs.h"
#include "core/config/config.h"
#include "core/error.h"
#include "eval/describe.h"
#include "eval/information/information_text.h"
#include "simulator/scene/describe_mesh.h"
#include "simulator/simulation_config.h"

namespace saccade {
namespace {

struct InfoOptions {
  std::filesystem::path path;
  bool verify = false;
  bool information = false;
};

void refuse_for_scene(const InfoOptions& options) {
  if (options.verify)
    throw InputError("--verify", "compares datasets with their hashes, no scenes");
  if (options.information)
    throw InputError("--information", "needs a dataset folder, with its poses, frames and depth");
}

void refuse_both(const InfoOptions& options) {
  if (options.verify) throw InputError("--information", "cannot be had with --verify: ask twice");
}

void info(const InfoOptions& options) {
  const bool is_folder = std::filesystem::is_directory(options.path);
  if (!is_folder && is_mesh_name(options.path)) {
    refuse_for_scene(options);
    fmt::print("{}", describe_mesh(options.path));
    return;
  }
  if (!is_folder && options.path.extension() == ".yaml") {
    refuse_for_scene(options);
    const auto config = config::read<SimulationConfig>(config::load(options.path.string(), {}));
    fmt::print("{}: simulation, {}", options.path.string(), describe_scene(config.scene));
    return;
  }
  if (options.information) {
    refuse_both(options);
    fmt::print("{}", describe_information(options.path));
    return;
  }
  const PathDescription description = describe_path(options.path, options.verify);
  fmt::print("{}", description.text);
  if (description.problems.empty()) return;
  std::string all = "does not match its hashes:";
  for (const std::string& problem : description.problems) all += "\n  " + problem;
  throw InputError(options.path.string(), all);
}

}  // namespace

void add_info_verb(CLI::App& command) {
  const auto options = std::make_shared<InfoOptions>();
  CLI::App* verb = command.add_subcommand(
      "info", "Say what a dataset, event file, run, mesh file or simulation configuration holds.");
  verb->add_option("PATH", options->path,
                   "Dataset folder, run folder, event file, mesh file (also archive.zip!/mesh.obj) "
                   "or simulation configuration (YAML).")
      ->required();
  verb->add_flag("--verify", options->verify, "Compare every file with its hash in dataset.yaml.");
  verb->add_flag("--information", options->information,
                 "Say instead how well a dataset's events can tell path and depth at best, by its "
                 "truth alone.");
  verb->footer(
      "Examples:\n"
      "  saccade info data/walls --verify\n"
      "  saccade info data/walls --information\n"
      "  saccade info chair.glb\n"
      "  saccade info configs/simulation/office.yaml");
  verb->callback([options] { info(*options); });
}

}  // namespace saccade
