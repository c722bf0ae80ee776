#include "estimator/external/external_module.h"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <functional>
#include <optional>
#include <span>
#include <string_view>

#include "core/config/config.h"
#include "core/error.h"
#include "core/io/tables/text_table.h"
#include "core/io/trajectory_file.h"
#include "core/process/progress.h"
#include "core/process/shell.h"
#include "core/stopwatch.h"
#include "estimator/external/adapter_config.h"
#include "estimator/external/command_template.h"
#include "estimator/external/container.h"
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
  if (config.container) {
    std::vector<fs::path> readable{values.at("dataset")};
    for (const auto& [name, file] : config.files)
      readable.push_back(fs::absolute(file).parent_path());
    call.words = words_in_container(call.words, fs::absolute(*config.container), run, readable);
  }
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

/// The time that a method of the Python module stated beside its results.
double stated_wall_s(const fs::path& out) {
  TextReader reader(out / "wall_s.txt");
  std::string_view line;
  if (!reader.next(line)) throw InputError("wall_s.txt", "holds no time");
  return reader.row(line).number("wall_s");
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
    const bool is_method = config.python && !end.timed_out && end.end.exit_code == 0;
    timing.wall_s.push_back(is_method ? stated_wall_s(call.working_folder) : end.wall_s);
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
  if (shell_words(command_of(config)).empty())
    throw InputError("command", "the adapter must state the program's command line (-c ADAPTER)");
  if (config.container && !fs::exists(*config.container))
    throw InputError("container", "no such file '" + config.container->string() + "'");
  for (const auto& [name, file] : config.files)
    if (!fs::exists(file))
      throw InputError("files." + name, "no such file '" + file.string() + "'");
}

/// Does the work of a run as often as it is to be repeated, and leaves its results in
/// RUN/output.
using Work = std::function<RunRecord::External(const fs::path& run, const Dataset& dataset,
                                               std::span<const Event> events,
                                               const Placeholders& values, RunTiming& timing)>;

RunSummary run_adapter(const RunRequest& request, const AdapterConfig& config, const Work& work) {
  RunWriter writer(request);
  const fs::path run = fs::absolute(writer.path());
  RunTiming timing;
  std::optional<ScopedTimer> io(timing.io_s);
  const Dataset dataset = Dataset::open(request.dataset);
  const Events events = load_events(request, dataset);
  ExternalInput input = write_external_input(run / "input", config, request, dataset, events);
  for (const auto& [name, file] : config.files) input.values[name] = fs::absolute(file);
  input.values["out"] = run / "output";
  fs::create_directories(run / "output");
  io.reset();
  timing.events = events.size();
  timing.sequence_s = seconds_from_ns(events.back().t_ns - events.front().t_ns);

  RunRecord::External external = work(run, dataset, events, input.values, timing);
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

/// The configuration of a program, with the file of a method among its files.
AdapterConfig read_adapter(const RunRequest& request) {
  AdapterConfig config = read_config<AdapterConfig>(request);
  if (!config.python) return config;
  config.files["program"] = *config.python;
  // Binary, and exact: the text of millions of events takes longer to read than most methods.
  config.events = "h5";
  config.event_unit = StampUnit::kNanoseconds;
  return config;
}

}  // namespace

RunSummary run_external(const RunRequest& request) {
  const AdapterConfig config = read_adapter(request);
  static_cast<void>(Dataset::open(request.dataset));  // what is missing first is said first
  check_program(config);
  return run_adapter(request, config,
                     [&](const fs::path& run, const Dataset&, std::span<const Event>,
                         const Placeholders& values, RunTiming& timing) {
                       const std::string version = version_of(config, values, run);
                       RunRecord::External external =
                           run_repetitions(call_of(config, command_of(config), values, run), config,
                                           request.repeat, timing);
                       external.version = version;
                       return external;
                     });
}

RunSummary run_method(const RunRequest& request,
                      const std::function<MethodResult(const MethodInputs&)>& method) {
  const AdapterConfig config = read_config<AdapterConfig>(request);
  const bool takes_imu =
      config.method_class && config.method_class->inputs.contains(MethodInput::kImu);
  return run_adapter(
      request, config,
      [&](const fs::path& run, const Dataset& dataset, std::span<const Event> events,
          const Placeholders&, RunTiming& timing) {
        MethodInputs inputs{dataset.camera(), events, {}, {}, config.seed};
        if (config.truth_s > 0)
          inputs.start =
              groundtruth_start(dataset, seconds_from_ns(events.front().t_ns), config.truth_s);
        if (takes_imu) inputs.imu = imu_window(request, dataset, events);
        MethodResult result;
        for (int i = 0; i < request.repeat; ++i) {
          result = method(inputs);
          timing.wall_s.push_back(result.wall_s);
        }
        write_tum_trajectory(run / "output" / config.output.trajectory.file, result.poses);
        RunRecord::External external;
        external.name = config.name;
        return external;
      });
}

}  // namespace saccade
