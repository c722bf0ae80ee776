#include <fmt/core.h>

#include <cstddef>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "apps/common_options.h"
#include "apps/option_checks.h"
#include "apps/verbs.h"
#include "eval/statistics/statistics_report.h"

namespace saccade {
namespace {

struct StatisticsOptions {
  std::vector<std::filesystem::path> paths;
  std::optional<std::filesystem::path> output;
  RecordingPart part;
  CommonOptions common;
};

/// Recordings whose names are alike are named as they were given.
void name_apart(std::vector<StreamStatistics>& recordings,
                const std::vector<std::filesystem::path>& paths) {
  std::map<std::string, int> count;
  for (const StreamStatistics& recording : recordings) ++count[recording.name];
  for (std::size_t i = 0; i < recordings.size(); ++i)
    if (count[recordings[i].name] > 1) recordings[i].name = paths[i].string();
}

void show_statistics(const StatisticsOptions& options) {
  options.common.apply();
  std::vector<StreamStatistics> recordings;
  for (const std::filesystem::path& path : options.paths)
    recordings.push_back(statistics_of_recording(path, options.part));
  name_apart(recordings, options.paths);
  fmt::print("{}", statistics_table(recordings));
  if (!options.output) return;
  write_statistics(recordings, *options.output);
  if (!options.common.quiet) fmt::print("wrote {}\n", options.output->string());
}

}  // namespace

void add_statistics_verb(CLI::App& command) {
  const auto options = std::make_shared<StatisticsOptions>();
  CLI::App* verb = command.add_subcommand(
      "statistics", "Hold the events of recordings against each other: rates, gaps, noise.");
  verb->add_option("PATH", options->paths, "Dataset folders or event files.")->required();
  verb->add_option("-o,--output", options->output, "Folder for tables (.csv) and a picture.")
      ->type_name("FOLDER");
  verb->add_option("--start-s", options->part.start_s,
                   "Begin of the part that counts (default: first event).")
      ->check(number_between(-kLongest_s, kLongest_s));
  verb->add_option("--duration-s", options->part.duration_s, "Length of the part that counts.")
      ->check(number_between(1e-9, kLongest_s));
  add_common_options(*verb, options->common);
  verb->footer(
      "Example:\n"
      "  saccade statistics data/slider_depth data/slider_like -o realism --duration-s 0.17");
  verb->callback([options] { show_statistics(*options); });
}

}  // namespace saccade
