#include <fmt/core.h>

#include <filesystem>
#include <memory>

#include "apps/verbs.h"
#include "core/error.h"
#include "eval/describe.h"

namespace saccade {
namespace {

struct InfoOptions {
  std::filesystem::path path;
  bool verify = false;
};

void info(const InfoOptions& options) {
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
  CLI::App* verb = command.add_subcommand("info", "Say what a dataset, event file or run holds.");
  verb->add_option("PATH", options->path, "Dataset folder, run folder, or event file.")->required();
  verb->add_flag("--verify", options->verify, "Compare every file with its hash in dataset.yaml.");
  verb->footer("Example:\n  saccade info data/walls --verify");
  verb->callback([options] { info(*options); });
}

}  // namespace saccade
