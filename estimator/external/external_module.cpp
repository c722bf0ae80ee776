#include "estimator/external/external_module.h"

#include <fmt/format.h>
#include <poll.h>
#include <sys/resource.h>

#include <algorithm>
#include <chrono>
#include <deque>
#include <filesystem>
#include <fstream>
#include <optional>
#include <string>
#include <vector>

#include "core/config/config.h"
#include "core/error.h"
#include "core/io/trajectory_file.h"
#include "core/process/child_process.h"
#include "core/process/progress.h"
#include "core/process/shell.h"
#include "core/stopwatch.h"
#include "estimator/external/adapter_config.h"
#include "estimator/external/command_template.h"
#include "estimator/external/external_input.h"
#include "estimator/external/external_output.h"
#include "estimator/run/run_input.h"
#include "estimator/run/run_writer.h"

namespace saccade {
namespace {

/// One call of an external program.
struct ExternalCall {
  std::vector<std::string> words;  ///< program and arguments
  std::filesystem::path working_folder;
  std::filesystem::path log;  ///< its output is appended
  double timeout_s = 3600;
};

/// Exit status and resources of a call.
struct ExternalEnd {
  ChildEnd end;
  double wall_s = 0;
  double peak_memory_mb = 0;  ///< of its largest process
  bool timed_out = false;
};

using Clock = std::chrono::steady_clock;

constexpr int kWaitMs = 20;
/// How long the program may take to end after it was asked to.
constexpr double kPatienceS = 5;

/// Waits for the end, at most until `limit`, or until this program is to end; raises `memory_mb`.
std::optional<ChildEnd> wait_until(ChildProcess& process, Clock::time_point limit,
                                   const InterruptGuard* interrupt, double& memory_mb) {
  for (;;) {
    if (auto end = process.poll_end()) return end;
    memory_mb = std::max(memory_mb, process.memory_mb());
    const auto left = std::chrono::ceil<std::chrono::milliseconds>(limit - Clock::now()).count();
    if (left <= 0 || (interrupt != nullptr && interrupt->requested())) return std::nullopt;
    pollfd ended{process.descriptor(), POLLIN, 0};
    ::poll(&ended, 1, static_cast<int>(std::min<std::int64_t>(left, kWaitMs)));
  }
}

/// What the system says of all its processes is exact, but counts this program's memory before the
/// start as theirs; what was looked at meanwhile is not.
double peak_memory_mb(const ChildEnd& end, double seen_mb) {
  rusage own{};
  getrusage(RUSAGE_SELF, &own);
  const bool is_theirs = end.peak_memory_mb > static_cast<double>(own.ru_maxrss) / 1024;
  return is_theirs ? end.peak_memory_mb : seen_mb;
}

Clock::time_point after(double seconds) {
  // A year is for ever; more could overflow the clock.
  constexpr double kForeverS = 3e7;
  return Clock::now() + std::chrono::duration_cast<Clock::duration>(
                            std::chrono::duration<double>(std::min(seconds, kForeverS)));
}

/// Runs the program and waits for its end. At the time-out it receives SIGTERM, five seconds later it
/// is killed with its children. Throws InputError where it cannot be started, and where saccade
/// itself is interrupted, after ending the program.
ExternalEnd run_external_program(const ExternalCall& call) {
  const InterruptGuard interrupt;
  const Stopwatch stopwatch;
  ChildProcess process(call.words.front(), call.words, call.log, call.working_folder);
  ExternalEnd result;
  double seen_mb = 0;
  std::optional<ChildEnd> end = wait_until(process, after(call.timeout_s), &interrupt, seen_mb);
  result.wall_s = stopwatch.seconds();
  if (!end) {
    result.timed_out = true;
    process.stop();
    end = wait_until(process, after(kPatienceS), nullptr, seen_mb);
  }
  if (interrupt.requested()) throw InputError(call.words.front(), "was interrupted");
  if (end) result.end = *end;
  result.peak_memory_mb = peak_memory_mb(result.end, seen_mb);
  return result;
}

/// The last lines of a log as the reason of a failure: at most three, of the last repetition.
std::string log_tail(const std::filesystem::path& log) {
  constexpr std::size_t kLines = 3;
  constexpr std::size_t kLongest = 200;  // of a line
  std::ifstream file(log);
  std::deque<std::string> lines;
  for (std::string line; std::getline(file, line);) {
    if (line.empty()) continue;
    if (line.starts_with("$ ")) {
      lines.clear();  // the words of the next repetition
      continue;
    }
    lines.push_back(line.substr(0, kLongest));
    if (lines.size() > kLines) lines.pop_front();
  }
  std::string text;
  for (const std::string& line : lines) text += (text.empty() ? "" : " / ") + line;
  return text;
}

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

/// Takes its poses into the run, or states why there are none.
std::size_t take_output(const fs::path& run, const AdapterConfig& config,
                        RunRecord::External& external) {
  if (external.status == "ok") try {
      return import_external_output(run / "output", config.output, run);
    } catch (const InputError& error) {
      external.status = "bad output";
      external.reason = error.what();
      // The folder gets its final name later: paths in the reason are relative.
      const std::string prefix = (run / "output").string() + "/";
      if (const auto at = external.reason.find(prefix); at != std::string::npos)
        external.reason.erase(at, prefix.size());
    }
  write_tum_trajectory(run / "trajectory.txt", {});
  return 0;
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
  timing.poses = take_output(run, config, external);
  fs::remove_all(run / "input");
  io.reset();
  writer.finish("external", request, dataset, input.window, config.seed, config::print(config),
                timing, external);
  RunSummary summary = summary_of(timing, fmt::format("{} poses", *timing.poses));
  if (external.status != "ok")
    show_notice(fmt::format("{} {}: {}", config.name, external.status, external.reason));
  return summary;
}

}  // namespace saccade
