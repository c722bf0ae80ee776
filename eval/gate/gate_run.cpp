#include "eval/gate/gate_run.h"

#include <array>

#include "core/error.h"
#include "core/io/run_record.h"
#include "core/shell.h"
#include "eval/metrics/metrics.h"

namespace saccade {
namespace {

namespace fs = std::filesystem;

/// "Intel(R) Xeon(R) Processor, Linux 6.1" without the last number: a new kernel is no new machine.
std::string machine_kind(const std::string& machine) {
  const std::size_t system = machine.rfind(", ");
  if (system == std::string::npos) return machine;
  return machine.substr(0, machine.find(' ', system + 2));
}

/// "-c configs/tracking/best.yaml --set align.samples=9" is "best align.samples=9".
std::string config_name(const std::string& command) {
  std::string name = "default", settings;
  const std::vector<std::string> words = shell_words(command);
  for (std::size_t i = 0; i + 1 < words.size(); ++i) {
    if (words[i] == "-c" || words[i] == "--config") name = fs::path(words[i + 1]).stem().string();
    if (words[i] == "--set") settings += " " + words[i + 1];
  }
  return name + settings;
}

/// Of the speed what one run can be compared by; the rest changes with every run.
bool is_kept(const std::string& key) {
  return !key.starts_with("speed.") || key.starts_with("speed.wall_s") || key == "speed.events" ||
         key == "speed.repetitions";
}

fs::path without_slash(const fs::path& folder) {
  return folder.has_filename() ? folder : folder.parent_path();
}

}  // namespace

std::string GateKey::sequence() const { return dataset + ", " + module + " " + config; }

std::string GateKey::text() const { return sequence() + ", seed " + std::to_string(seed); }

std::optional<double> GateRun::get(const std::string& metric) const {
  const auto found = metrics.find(metric);
  return found == metrics.end() ? std::nullopt : found->second;
}

GateRun read_gate_run(const fs::path& folder) {
  const RunRecord record = read_run_record(folder / "run.yaml");
  const fs::path scores = folder / "metrics.json";
  if (!fs::exists(scores))
    throw InputError(folder.string(),
                     "has not been scored; first: " + shell_line(std::array<std::string, 3>{
                                                          "saccade", "eval", folder.string()}));
  GateRun run;
  run.key = {without_slash(record.dataset).filename().string(), record.module,
             config_name(record.command), record.seed};
  run.machine = machine_kind(record.machine);
  run.threads = record.threads;
  run.tool_version = record.tool_version;
  const Metrics metrics = read_json_metrics(scores);
  for (const auto& [key, value] : metrics.values())
    if (is_kept(key)) run.metrics.emplace(key, value);
  return run;
}

std::vector<GateRun> read_gate_runs(const std::vector<fs::path>& folders) {
  std::vector<GateRun> runs;
  std::map<GateKey, fs::path> where;
  for (const fs::path& folder : folders) {
    runs.push_back(read_gate_run(folder));
    const auto [first, is_new] = where.emplace(runs.back().key, folder);
    if (!is_new)
      throw InputError(
          folder.string(),
          "is the same work as " + first->second.string() + " (" + runs.back().key.text() +
              "); runs of one comparison differ in dataset, module, -c, --set or seed");
  }
  return runs;
}

}  // namespace saccade
