#include "eval/gate/gate_run.h"

#include <array>

#include "core/error.h"
#include "core/io/files/folder_name.h"
#include "core/process/shell.h"
#include "eval/configuration_name.h"

namespace saccade {
namespace {

namespace fs = std::filesystem;

/// "Intel(R) Xeon(R) Processor, Linux 6.1" without the last number: a new kernel is no new machine.
std::string machine_kind(const std::string& machine) {
  const std::size_t system = machine.rfind(", ");
  if (system == std::string::npos) return machine;
  return machine.substr(0, machine.find(' ', system + 2));
}

/// The other speed metrics change with every run.
bool is_kept(const std::string& key) {
  return !key.starts_with("speed.") || key.starts_with("speed.wall_s") || key == "speed.events" ||
         key == "speed.repetitions";
}

}  // namespace

std::string GateKey::sequence() const {
  return dataset + ", " + module + (config.empty() ? "" : " " + config);
}

std::string GateKey::text() const { return sequence() + ", seed " + std::to_string(seed); }

std::optional<double> GateRun::get(const std::string& metric) const {
  const auto found = metrics.find(metric);
  return found == metrics.end() ? std::nullopt : found->second;
}

GateRun gate_run(const RunRecord& record, const Metrics& metrics) {
  GateRun run;
  run.key = {folder_name(record.dataset), record.module, configuration_name(record), record.seed};
  run.machine = machine_kind(record.machine);
  run.threads = record.threads;
  run.tool_version = record.tool_version;
  for (const auto& [key, value] : metrics.values())
    if (is_kept(key)) run.metrics.emplace(key, value);
  return run;
}

GateRun read_gate_run(const fs::path& folder) {
  const RunRecord record = read_run_record(folder / "run.yaml");
  const fs::path scores = folder / "metrics.json";
  if (!fs::exists(scores))
    throw InputError(folder.string(),
                     "has not been scored; first: " + shell_line(std::array<std::string, 3>{
                                                          "saccade", "eval", folder.string()}));
  return gate_run(record, read_json_metrics(scores));
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
          "has the same key as " + first->second.string() + " (" + runs.back().key.text() +
              "); runs of one comparison differ in dataset, module, -c, --set or seed");
  }
  return runs;
}

}  // namespace saccade
