#include "eval/gate/gate_run.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <set>
#include <string_view>
#include <utility>

#include "core/config/suggest.h"
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

bool is_time(const std::string& key) { return key.starts_with("speed."); }

MachineTimes times_of(const GateRun& run) {
  MachineTimes times{run.machine, run.threads, {}};
  for (const auto& metric : run.metrics)
    if (is_time(metric.first)) times.metrics.insert(metric);
  return times;
}

bool is_of(const MachineTimes& times, const GateRun& run) {
  return times.machine == run.machine && times.threads == run.threads;
}

/// A "key=value" within a configuration's name (eval/configuration_name.h), from the blank before it
/// to its end.
struct Setting {
  std::string key;
  std::size_t begin = 0;
  std::size_t end = 0;
};

/// The key of the setting whose blank is at `blank`; empty where none begins there.
std::string key_after(const std::string& name, std::size_t blank) {
  const auto is_letter = [](char c) {
    return std::isalpha(static_cast<unsigned char>(c)) || c == '_';
  };
  const auto is_of_key = [&](char c) {
    return is_letter(c) || std::isdigit(static_cast<unsigned char>(c)) || c == '.';
  };
  const auto begin = name.begin() + static_cast<std::ptrdiff_t>(blank) + 1;
  const auto end = std::find_if_not(begin, name.end(), is_of_key);
  const bool is_setting = begin != end && is_letter(*begin) && end != name.end() && *end == '=';
  return is_setting ? std::string(begin, end) : std::string();
}

/// A value may hold blanks and commas: it ends where the next setting begins, or at what the name
/// says of the poses and the depth.
std::vector<Setting> settings_of(const std::string& name) {
  std::vector<Setting> settings;
  bool is_open = false;
  for (std::size_t at = name.find_first_of(" ,"); at != std::string::npos;
       at = name.find_first_of(" ,", at + 1)) {
    const std::string_view rest = std::string_view(name).substr(at);
    const bool is_source = rest.starts_with(", estimated ") || rest.starts_with(", smoothed ");
    std::string key = name[at] == ' ' ? key_after(name, at) : std::string();
    if (is_open && (is_source || !key.empty())) settings.back().end = at;
    if (is_source) is_open = false;
    if (key.empty()) continue;
    settings.push_back({std::move(key), at, name.size()});
    is_open = true;
  }
  return settings;
}

std::set<std::string> keys_set(std::span<const GateRun> runs) {
  std::set<std::string> keys;
  for (const GateRun& run : runs)
    for (const Setting& setting : settings_of(run.key.config)) keys.insert(setting.key);
  return keys;
}

bool is_below(const std::string& key, const std::string& compared) {
  return key == compared || key.starts_with(compared + ".");
}

std::string without(const std::string& name, const std::vector<std::string>& compared) {
  std::string kept = name.substr(0, name.find_first_of(" ,"));
  const std::string rest = name.substr(kept.size());
  if (std::find(compared.begin(), compared.end(), "config") != compared.end()) kept = "(any)";
  std::size_t done = 0;
  for (const Setting& setting : settings_of(rest)) {
    const bool is_compared =
        std::any_of(compared.begin(), compared.end(),
                    [&](const std::string& key) { return is_below(setting.key, key); });
    kept += rest.substr(done, (is_compared ? setting.begin : setting.end) - done);
    done = setting.end;
  }
  return kept + rest.substr(done);
}

void check_distinct(std::span<const GateRun> runs, const char* side) {
  std::set<GateKey> keys;
  for (const GateRun& run : runs)
    if (!keys.insert(run.key).second)
      throw InputError("--compare", std::string("two runs of the ") + side +
                                        " then do the same work: " + run.key.text());
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

void take_times_of_same_machine(std::vector<GateRun>& baseline, std::span<const GateRun> runs) {
  for (GateRun& before : baseline) {
    const auto after = std::find_if(runs.begin(), runs.end(),
                                    [&](const GateRun& run) { return run.key == before.key; });
    if (after == runs.end() || is_of(times_of(before), *after)) continue;
    const auto same = std::find_if(before.elsewhere.begin(), before.elsewhere.end(),
                                   [&](const MachineTimes& times) { return is_of(times, *after); });
    if (same == before.elsewhere.end()) continue;
    const MachineTimes own = std::exchange(*same, times_of(before));
    std::erase_if(before.metrics, [](const auto& metric) { return is_time(metric.first); });
    before.metrics.insert(own.metrics.begin(), own.metrics.end());
    before.machine = own.machine;
    before.threads = own.threads;
  }
}

void keep_times_of_other_machines(GateRun& run, const GateRun& old) {
  std::vector<MachineTimes> known = old.elsewhere;
  known.push_back(times_of(old));
  for (MachineTimes& times : known)
    if (!is_of(times, run) && !times.machine.empty()) run.elsewhere.push_back(std::move(times));
  std::sort(run.elsewhere.begin(), run.elsewhere.end(),
            [](const MachineTimes& a, const MachineTimes& b) {
              return std::pair(a.machine, a.threads) < std::pair(b.machine, b.threads);
            });
}

void leave_out_compared(std::vector<GateRun>& baseline, std::vector<GateRun>& runs,
                        const std::vector<std::string>& compared) {
  if (compared.empty()) return;
  std::set<std::string> known = keys_set(baseline);
  known.merge(keys_set(runs));
  for (const std::string& key : compared) {
    const bool was_set =
        key == "config" || std::any_of(known.begin(), known.end(),
                                       [&](const std::string& set) { return is_below(set, key); });
    if (was_set) continue;
    const std::vector<std::string> names(known.begin(), known.end());
    const auto near = config::nearest(key, names);
    throw InputError("--compare", "no run has a --set of '" + key + "'" +
                                      (near ? "; did you mean '" + *near + "'?" : ""));
  }
  for (auto* side : {&baseline, &runs})
    for (GateRun& run : *side) run.key.config = without(run.key.config, compared);
  check_distinct(baseline, "baseline");
  check_distinct(runs, "call");
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
