#include "eval/report/run_data.h"

#include <algorithm>
#include <map>
#include <set>
#include <tuple>

#include <fmt/format.h>

#include "core/error.h"
#include "core/io/event_file.h"
#include "eval/configuration_name.h"
#include "eval/evaluate.h"
#include "eval/refined_ratio.h"

namespace saccade {
namespace {

void score(RunData& data) {
  data.input = score_input(data.run, *data.data);
  // Where the dataset states no depth, the one that `eval` was given holds here as well.
  if (!data.input.mean_depth_m)
    data.input.mean_depth_m = data.run.metrics.get("trajectory.mean_depth_m");
  data.samples = scored_samples(data.input);
  data.errors = errors_over_time(data.input);
  data.map = data.run.load_map().positions;
  data.keyframes = KeyframeHistory::load(data.run);
  data.reprojection = reproject(data.map, data.samples, data.data->camera().undistorted());
  data.metrics = score_run(data.run, *data.data, data.input.mean_depth_m);
}

}  // namespace

DatasetNumbers numbers_of(const Dataset& dataset) {
  DatasetNumbers numbers;
  if (!dataset.events_file().empty()) {
    const EventFileInfo info = read_event_file_info(dataset.events_file());
    numbers.events = static_cast<double>(info.count);
    numbers.duration_s = seconds_from_ns(info.last_ns - info.first_ns);
  }
  numbers.mean_depth_m = dataset.facts().mean_depth_m;
  if (!dataset.groundtruth().empty()) {
    numbers.path_m = dataset.groundtruth().path_length();
    // The last event of a simulation comes a little before its end.
    if (dataset.record())
      numbers.duration_s = dataset.groundtruth().end_s() - dataset.groundtruth().start_s();
  }
  return numbers;
}

RunData gather_run(const std::filesystem::path& folder, std::size_t index) {
  RunData data;
  data.id = "run" + std::to_string(index);
  data.run = RunFolder::open(folder);
  const RunRecord& record = data.run.record;
  data.method =
      record.external ? record.external->name : record.module + " " + configuration_name(record);
  data.fast = data.run.name().find("fast") != std::string::npos;
  data.metrics = data.run.metrics;
  data.dataset = record.dataset.filename().string();
  if (!std::filesystem::is_directory(record.dataset)) {
    data.missing = record.dataset.string() + " is not there";
    return data;
  }
  data.data = data.run.open_dataset();
  data.dataset = data.data->facts().name;
  data.numbers = numbers_of(*data.data);
  score(data);
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
  const auto file_of = [](const RunData& data) {
    return configuration_file(data.run.record).lexically_normal();
  };
  struct Sources {
    std::set<std::filesystem::path> files;
    std::set<std::string> values;  ///< SHA-256
  };
  std::map<std::tuple<std::string, std::uint64_t, std::string>, Sources> sources;
  for (const RunData& data : runs) {
    if (data.run.record.external) continue;
    Sources& same = sources[{data.dataset, data.run.record.seed, data.method}];
    same.files.insert(file_of(data));
    same.values.insert(configuration_sha256(data.run.record));
  }
  std::set<std::string> ambiguous;
  for (const auto& [key, same] : sources)
    if (same.files.size() > 1 && same.values.size() > 1) ambiguous.insert(std::get<2>(key));
  for (RunData& data : runs) {
    if (!ambiguous.contains(data.method)) continue;
    const std::string folder = file_of(data).parent_path().generic_string();
    data.method += fmt::format(" ({})", folder.empty() ? "." : folder);
  }
}

}  // namespace saccade
