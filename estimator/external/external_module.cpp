#include "estimator/external/external_module.h"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <optional>
#include <span>

#include "core/config/config.h"
#include "core/error.h"
#include "core/process/progress.h"
#include "core/process/shell.h"
#include "core/stopwatch.h"
#include "estimator/external/adapter_config.h"
#include "estimator/external/command_template.h"
#include "estimator/external/external_input.h"
#include "estimator/external/external_output.h"
#include "estimator/external/external_process.h"
#include "estimator/run/run_input.h"
#include "estimator/run/run_writer.h"

namespace saccade {
namespace {

namespace fs = std::filesystem;

ExternalCall call_of(const AdapterConfig& config, const std::string& command,
                     const Placeholders& values, const fs::path& run) {
  ExternalCall call;
  call.words = substituted_words(command, values);
  call.working_folder = run / "output";
  call.log = run / "log.txt";
  call.timeout_s = config.timeout_s;
  return call;
}

/// The first line that the version command prints.
std::string version_of(const AdapterConfig& config, const Placeholders& values,
                       const fs::path& run) {
  if (config.version_command.empty()) return {};
  ExternalCall call = call_of(config, config.version_command, values, run);
  call.log = run / "version.txt";
  const ExternalEnd end = run_external_program(call);
  std::ifstream file(call.log);
  std::string words, version;
  std::getline(file, words);
  std::getline(file, version);
  file.close();
  fs::remove(call.log);
  if (end.timed_out || end.end.exit_code != 0)
    throw InputError("version_command", "failed: " + shell_line(call.words));
  return version;
}

/// Runs the program `repeat` times or until it fails; its status.
RunRecord::External run_repetitions(const ExternalCall& call, const AdapterConfig& config,
                                    int repeat, RunTiming& timing) {
  RunRecord::External external;
  external.name = config.name;
  Progress progress(config.name, static_cast<std::uint64_t>(repeat), "repetitions");
  for (int i = 0; i < repeat; ++i) {
    fs::remove_all(call.working_folder);
    fs::create_directories(call.working_folder);
    const ExternalEnd end = run_external_program(call);
    timing.wall_s.push_back(end.wall_s);
    timing.cpu_s.push_back(end.end.cpu_s);
    timing.peak_memory_mb = std::max(timing.peak_memory_mb.value_or(0), end.peak_memory_mb);
    progress.add(1);
    if (end.timed_out) {
      external.status = "timed out";
      external.reason = fmt::format("after {:g} s", config.timeout_s);
    } else if (end.end.exit_code != 0) {
      external.status = "crashed";
      external.reason = end.end.text();
    }
    if (external.status == "ok") continue;
    if (const std::string words = log_tail(call.log); !words.empty())
      external.reason += "; log: " + words;
    break;
  }
  return external;
}

/// Takes its results into the run, or states why there are none.
ExternalFound take_output(const fs::path& run, const AdapterConfig& config,
                          const PinholeCamera& camera, RunRecord::External& external) {
  if (external.status == "ok") try {
      return import_external_output(run / "output", config.output, camera, run);
    } catch (const InputError& error) {
      external.status = "bad output";
      external.reason = error.what();
      // The folder gets its final name later: paths in the reason are relative.
      const std::string prefix = (run / "output").string() + "/";
      if (const auto at = external.reason.find(prefix); at != std::string::npos)
        external.reason.erase(at, prefix.size());
    }
  return write_no_output(config.output, camera, run);
}

/// Throws InputError where there is nothing to run.
void check_program(const AdapterConfig& config) {
  if (shell_words(config.command).empty())
    throw InputError("command", "the adapter must state the program's command line (-c ADAPTER)");
  for (const auto& [name, file] : config.files)
    if (!fs::exists(file))
      throw InputError("files." + name, "no such file '" + file.string() + "'");
}

}  // namespace

RunSummary run_external(const RunRequest& request) {
  const AdapterConfig config = read_config<AdapterConfig>(request);
  RunWriter writer(request);
  const fs::path run = fs::absolute(writer.path());
  RunTiming timing;
  std::optional<ScopedTimer> io(timing.io_s);
  const Dataset dataset = Dataset::open(request.dataset);
  check_program(config);
  const Events events = load_events(request, dataset);
  ExternalInput input = write_external_input(run / "input", config, request, dataset, events);
  for (const auto& [name, file] : config.files) input.values[name] = fs::absolute(file);
  input.values["out"] = run / "output";
  fs::create_directories(run / "output");
  io.reset();
  timing.events = events.size();
  timing.sequence_s = seconds_from_ns(events.back().t_ns - events.front().t_ns);

  const std::string version = version_of(config, input.values, run);
  RunRecord::External external = run_repetitions(call_of(config, config.command, input.values, run),
                                                 config, request.repeat, timing);
  external.version = version;
  io.emplace(timing.io_s);
  const ExternalFound found = take_output(run, config, dataset.camera(), external);
  timing.poses = found.poses;
  fs::remove_all(run / "input");
  io.reset();
  if (config.method_class) writer.set_class(*config.method_class);
  writer.finish("external", request, dataset, input.window, config.seed, config::print(config),
                timing, external);
  RunSummary summary = summary_of(timing, found.poses ? fmt::format("{} poses", *found.poses)
                                                      : fmt::format("{} events", found.events));
  if (external.status != "ok")
    show_notice(fmt::format("{} {}: {}", config.name, external.status, external.reason));
  return summary;
}

}  // namespace saccade
