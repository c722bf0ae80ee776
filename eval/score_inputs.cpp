#include "eval/score_inputs.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <span>
#include <string_view>
#include <utility>
#include <vector>

#include "core/io/files/sha256.h"
#include "core/version.h"
#include "eval/metrics/metrics.h"

namespace saccade {
namespace {

namespace fs = std::filesystem;

/// Scoring writes them into the run folder.
constexpr std::array<std::string_view, 2> kScores{"metrics.json", "depth_views.csv"};

constexpr std::array<std::pair<const char*, const char*>, 3> kReasons{
    {{"dataset_sha256", "the dataset has changed or is another one"},
     {"run_sha256", "the run has changed"},
     {"version", "another version of saccade scored it"}}};

std::string hash_of(const std::string& text) { return sha256(std::as_bytes(std::span(text))); }

std::string hash_of_run(const fs::path& folder) {
  std::vector<fs::path> files;
  for (const fs::directory_entry& entry : fs::recursive_directory_iterator(folder))
    if (entry.is_regular_file() && std::find(kScores.begin(), kScores.end(),
                                             entry.path().filename().string()) == kScores.end())
      files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  std::string list;
  for (const fs::path& file : files)
    list += fmt::format("{} {}\n", sha256_of_file(file),
                        file.lexically_relative(folder).generic_string());
  return hash_of(list);
}

std::string hash_of_dataset(const Dataset& dataset) {
  std::string list;
  const fs::path record = dataset.folder() / "dataset.yaml";
  const fs::path content = fs::exists(record) ? record : dataset.events_file();
  for (const fs::path& file : {content, dataset.folder() / "groundtruth.txt"})
    if (!file.empty() && fs::exists(file)) list += sha256_of_file(file) + "\n";
  return hash_of(list);
}

}  // namespace

ScoreInputs score_inputs(const fs::path& run_folder, const Dataset& dataset) {
  return {{"run_sha256", hash_of_run(run_folder)},
          {"dataset_sha256", hash_of_dataset(dataset)},
          {"version", fmt::format("{} ({})", version(), git_commit())}};
}

ScoreInputs recorded_inputs(const fs::path& run_folder) {
  const fs::path file = run_folder / "metrics.json";
  return fs::exists(file) ? read_json_texts(file, "inputs") : ScoreInputs{};
}

std::string staleness(const fs::path& run_folder, const Dataset& dataset) {
  if (!fs::exists(run_folder / "metrics.json")) return "it was not scored";
  ScoreInputs recorded = recorded_inputs(run_folder);
  if (recorded.empty()) return "metrics.json does not state what was scored";
  ScoreInputs now = score_inputs(run_folder, dataset);
  for (const auto& [name, reason] : kReasons)
    if (recorded[name] != now[name]) return reason;
  return "";
}

}  // namespace saccade
