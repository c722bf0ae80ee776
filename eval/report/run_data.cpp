#include "eval/report/run_data.h"

#include <algorithm>
#include <map>
#include <set>
#include <span>
#include <sstream>
#include <utility>

#include <fmt/format.h>

#include "core/error.h"
#include "core/io/events/event_file.h"
#include "core/io/files/sha256.h"
#include "eval/configuration_name.h"
#include "eval/evaluate.h"
#include "eval/refined_ratio.h"
#include "eval/score_inputs.h"

namespace saccade {
namespace {

void set_errors(RunData& data, bool with_reprojection) {
  data.input = score_input(data.run, *data.data);
  // The errors over time are relative to the depth that the scores are relative to; `eval` may have
  // been given another one than the dataset's.
  const std::optional<double> scored_m = data.run.metrics.get("trajectory.mean_depth_m");
  if (scored_m && (data.stale.empty() || !data.input.mean_depth_m))
    data.input.mean_depth_m = scored_m;
  data.samples = scored_samples(data.input);
  data.errors = errors_over_time(data.input);
  data.truth_from_estimate = truth_from_estimate(data.input);
  data.map = data.run.load_map().positions;
  if (with_reprojection)
    data.reprojection = reproject(data.truth_from_estimate * data.map, data.samples,
                                  data.data->camera().undistorted());
}

/// Takes the scores that `eval` wrote, or scores the run where they are stale.
void set_scores(RunData& data, bool with_reprojection) {
  data.stale = staleness(data.run.folder, *data.data);
  set_errors(data, with_reprojection);
  data.keyframes = KeyframeHistory::load(data.run);
  data.metrics = data.stale.empty() ? data.run.metrics
                                    : score_run(data.run, *data.data, data.input.mean_depth_m);
}

/// The run's configuration but for the seed, which every run has of its own.
std::string values_of(const RunRecord& record) {
  std::string values;
  std::istringstream lines(record.config_yaml);
  for (std::string line; std::getline(lines, line);)
    if (!line.starts_with("seed:")) values += line + "\n";
  return values;
}

/// The first eight digits of the SHA-256.
std::string short_hash(const std::string& text) {
  constexpr std::size_t kShown = 8;
  return sha256(std::as_bytes(std::span(text))).substr(0, kShown);
}

}  // namespace

Metrics facts_of(const Dataset& dataset) {
  Metrics facts;
  if (!dataset.events_file().empty()) {
    const EventFileInfo info = read_event_file_info(dataset.events_file());
    facts.set("dataset.events", static_cast<double>(info.count));
    facts.set("dataset.duration_s", seconds_from_ns(info.last_ns - info.first_ns));
  }
  facts.set("dataset.mean_scene_depth_m", dataset.facts().mean_depth_m);
  if (dataset.groundtruth().empty()) return facts;
  facts.set("dataset.path_length_m", dataset.groundtruth().path_length());
  // The last event of a simulation comes a little before its end.
  if (dataset.record())
    facts.set("dataset.duration_s",
              dataset.groundtruth().end_s() - dataset.groundtruth().start_s());
  return facts;
}

namespace {

/// The run folder with its dataset, if that is there.
RunData open_run(const std::filesystem::path& folder, std::size_t index) {
  RunData data;
  data.id = "run" + std::to_string(index);
  data.address = "#" + data.id;
  data.run = RunFolder::open(folder);
  const RunRecord& record = data.run.record;
  data.method =
      record.external ? record.external->name : record.module + " " + configuration_name(record);
  data.metrics = data.run.metrics;
  data.dataset = record.dataset.filename().string();
  if (!std::filesystem::is_directory(record.dataset)) {
    data.missing = record.dataset.string() + " is not there";
    return data;
  }
  data.data = data.run.open_dataset();
  data.dataset = data.data->facts().name;
  return data;
}

}  // namespace

RunData gather_run(const std::filesystem::path& folder, std::size_t index, bool with_reprojection) {
  RunData data = open_run(folder, index);
  if (!data.data) return data;
  data.facts = facts_of(*data.data);
  set_scores(data, with_reprojection);
  return data;
}

RunData gather_errors(const std::filesystem::path& folder, std::size_t index) {
  RunData data = open_run(folder, index);
  if (data.data) set_errors(data, true);
  return data;
}

void compare_with_refined(std::vector<RunData>& runs) {
  std::vector<const RunFolder*> folders;
  for (const RunData& data : runs) folders.push_back(&data.run);
  for (RunData& data : runs) {
    const RunFolder* refined = find_refined(data.run, folders);
    if (refined == nullptr) continue;
    const auto at = std::find(folders.begin(), folders.end(), refined);
    const RunData& optimum = runs[static_cast<std::size_t>(at - folders.begin())];
    const Metrics ratios = refined_ratios(data.metrics, optimum.metrics);
    for (const auto& [key, value] : ratios.values()) data.metrics.set(key, value);
  }
}

void tell_methods_apart(std::vector<RunData>& runs) {
  const auto folder_of = [](const RunData& data) {
    const std::filesystem::path file = configuration_file(data.run.record).lexically_normal();
    const std::string folder = file.parent_path().generic_string();
    return folder.empty() ? "." : folder;
  };
  // Of every dataset and method its values, and the folder where they were first met.
  std::map<std::pair<std::string, std::string>, std::map<std::string, std::string>> sources;
  for (const RunData& data : runs)
    if (!data.run.record.external)
      sources[{data.dataset, data.method}].emplace(values_of(data.run.record), folder_of(data));
  std::set<std::string> ambiguous, of_one_folder;
  for (const auto& [work, folders] : sources) {
    if (folders.size() < 2) continue;
    ambiguous.insert(work.second);
    std::set<std::string> different;
    for (const auto& [values, folder] : folders) different.insert(folder);
    if (different.size() < folders.size()) of_one_folder.insert(work.second);
  }
  for (RunData& data : runs) {
    if (data.run.record.external || !ambiguous.contains(data.method)) continue;
    const std::string values = values_of(data.run.record);
    const std::string& folder = sources.at({data.dataset, data.method}).at(values);
    data.method +=
        fmt::format(" ({})", of_one_folder.contains(data.method) ? short_hash(values) : folder);
  }
}

}  // namespace saccade
