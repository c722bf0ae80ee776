#include "estimator/run/run_writer.h"

#include <fmt/core.h>
#include <sys/resource.h>
#include <sys/utsname.h>

#include <algorithm>
#include <fstream>
#include <string_view>

#include "core/check.h"
#include "core/io/files/sha256.h"
#include "core/io/run/path_so_far.h"
#include "core/median.h"
#include "core/version.h"

namespace saccade {
namespace {

/// "Intel(R) Xeon(R) Processor, Linux 6.1".
std::string machine_name() {
  std::string processor = "unknown processor";
  std::ifstream info("/proc/cpuinfo");
  for (std::string line; std::getline(info, line);)
    if (line.starts_with("model name")) {
      processor = line.substr(line.find(':') + 2);
      break;
    }
  utsname name{};
  if (uname(&name) != 0) return processor;
  return processor + ", " + name.sysname + " " + name.release;
}

double peak_memory_mb() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) / 1024;
}

/// One entry of the JSON object: median, min and max of numerator / wall time.
std::string rate(std::string_view key, double numerator, const std::vector<double>& wall_s) {
  const auto [low, high] = std::minmax_element(wall_s.begin(), wall_s.end());
  // A run without events takes no time.
  const auto per = [numerator](double seconds) { return seconds > 0 ? numerator / seconds : 0; };
  return fmt::format("  \"{}\": {{\"median\": {}, \"min\": {}, \"max\": {}}},\n", key,
                     per(median(wall_s)), per(*high), per(*low));
}

/// Median, 99 % and most.
std::string latency(std::vector<double> ms) {
  std::sort(ms.begin(), ms.end());
  const auto at = [&](double quantile) {
    return ms[static_cast<std::size_t>(quantile * static_cast<double>(ms.size() - 1))];
  };
  return fmt::format("  \"latency_ms\": {{\"median\": {}, \"p99\": {}, \"max\": {}}},\n", at(0.5),
                     at(0.99), ms.back());
}

/// The class of a run with those of the runs that it starts from; nullopt where one is not known, as
/// of a trajectory of another program.
std::optional<MethodClass> class_with_sources(std::optional<MethodClass> own,
                                              const RunRequest& request) {
  for (const auto* source : {&request.poses_from, &request.depth_from, &request.from}) {
    if (!*source || !own) continue;
    const std::filesystem::path record = **source / "run.yaml";
    const std::optional<MethodClass> given =
        std::filesystem::exists(record) ? read_run_record(record).method_class : std::nullopt;
    own = given ? std::optional(merged(*own, *given)) : std::nullopt;
  }
  return own;
}

}  // namespace

std::string dataset_hash(const Dataset& dataset) {
  const std::filesystem::path record = dataset.folder() / "dataset.yaml";
  if (std::filesystem::exists(record)) return sha256_of_file(record);
  return dataset.events_file().empty() ? std::string() : sha256_of_file(dataset.events_file());
}

std::string to_json(const RunTiming& timing) {
  const auto [low, high] = std::minmax_element(timing.wall_s.begin(), timing.wall_s.end());
  std::string json = "{\n";
  json += fmt::format("  \"wall_s\": {{\"median\": {}, \"min\": {}, \"max\": {}}},\n",
                      median(timing.wall_s), *low, *high);
  if (!timing.cpu_s.empty()) json += fmt::format("  \"cpu_s\": {},\n", median(timing.cpu_s));
  json += fmt::format("  \"events\": {},\n", timing.events);
  json += rate("events_per_s", static_cast<double>(timing.events), timing.wall_s);
  if (timing.poses) {
    json += fmt::format("  \"poses\": {},\n", *timing.poses);
    json += rate("poses_per_s", static_cast<double>(*timing.poses), timing.wall_s);
  }
  json += rate("realtime_factor", timing.sequence_s, timing.wall_s);
  if (!timing.latency_ms.empty()) json += latency(timing.latency_ms);
  if (timing.dropped_events)
    json += fmt::format("  \"dropped_events\": {},\n", *timing.dropped_events);
  json += fmt::format("  \"repetitions\": {},\n", timing.wall_s.size());
  json += "  \"stages_s\": {";
  for (std::size_t i = 0; i < timing.stages_s.size(); ++i)
    json += fmt::format("{}\"{}\": {}", i == 0 ? "" : ", ", timing.stages_s[i].first,
                        timing.stages_s[i].second);
  json += fmt::format("}},\n  \"io_s\": {},\n  \"peak_memory_mb\": {}\n}}\n", timing.io_s,
                      timing.peak_memory_mb.value_or(peak_memory_mb()));
  return json;
}

RunSummary summary_of(const RunTiming& timing, const std::string& found) {
  RunSummary summary;
  summary.found = found;
  summary.events = timing.events;
  summary.poses = timing.poses.value_or(0);
  summary.wall_s = median(timing.wall_s);
  return summary;
}

RunWriter::RunWriter(const RunRequest& request) : folder_(request.output, "run.yaml") {}

void RunWriter::finish(const std::string& module, const RunRequest& request, const Dataset& dataset,
                       const RunRecord::Window& window, std::uint64_t seed,
                       const std::string& config_yaml, const RunTiming& timing,
                       const std::optional<RunRecord::External>& external) {
  SACCADE_CHECK(method_class_ || external);
  RunRecord record;
  record.module = module;
  record.method_class = class_with_sources(method_class_, request);
  record.contrast = contrast_;
  record.external = external;
  record.dataset = std::filesystem::absolute(request.dataset).lexically_normal();
  record.dataset_sha256 = dataset_hash(dataset);
  record.smooth_poses_s = request.smooth_poses_s;
  if (request.poses_from)
    record.poses_from = std::filesystem::absolute(*request.poses_from).lexically_normal();
  if (request.depth_from)
    record.depth_from = std::filesystem::absolute(*request.depth_from).lexically_normal();
  if (request.from) record.from = std::filesystem::absolute(*request.from).lexically_normal();
  record.window = window;
  record.seed = seed;
  record.threads = request.threads;
  record.tool_version = fmt::format("{} ({})", version(), git_commit());
  record.command = request.command;
  record.machine = machine_name();
  record.config_yaml = config_yaml;
  remove_path_so_far(path());
  write_atomically(path() / "timing.json", to_json(timing));
  // Last, as the folder's marker: a folder that is taken away meanwhile never stands there without it.
  write_run_record(path() / "run.yaml", record);
  folder_.commit();
}

}  // namespace saccade
