#include "eval/sweep/plan/calibration_run.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <fstream>
#include <initializer_list>
#include <iterator>
#include <numeric>
#include <optional>
#include <stdexcept>
#include <system_error>

#include "core/config/convert.h"
#include "core/config/document.h"
#include "core/error.h"
#include "core/io/dataset_record.h"
#include "core/io/scratch_folder.h"
#include "eval/metrics/statistics.h"
#include "eval/number_text.h"

namespace saccade {
namespace {

namespace fs = std::filesystem;
using Words = std::vector<std::string>;

constexpr std::size_t kPilots = 8;
constexpr double kWindowS = 0.025;

std::string text_of(const fs::path& file) {
  std::ifstream stream(file);
  return {std::istreambuf_iterator<char>(stream), {}};
}

/// Runs the jobs one at a time; the seconds that each took.
std::vector<double> run_all(const std::vector<LaunchJob>& jobs, Launcher& launcher) {
  std::vector<double> wall_s(jobs.size(), 0);
  const auto on_end = [&](std::size_t i, const LaunchResult& result) {
    if (!result.succeeded)
      throw InputError("generate", fmt::format("dataset {} cannot be simulated:\n{}", jobs[i].name,
                                               text_of(jobs[i].log)));
    wall_s[i] = result.wall_s;
  };
  if (!launcher.run(jobs, {1, 1}, {on_end, [] {}, [](const std::string&) {}}))
    throw std::runtime_error("interrupted");
  return wall_s;
}

/// The simulation's call into another folder, with more arguments.
LaunchJob changed_call(const SweepJob& job, const fs::path& folder, const std::string& piece,
                       const Words& more) {
  Words words = job.commands.at(0);
  const fs::path output = folder / job.name / piece;
  const auto option = std::find(words.begin(), words.end(), "-o");
  *(option + 1) = output.string();
  words.insert(words.end(), more.begin(), more.end());
  return {job.name, {words}, folder / job.name / (piece + ".txt"), {}};
}

/// What --print-config printed, as a number at a key; nullopt for `~` or no such key.
std::optional<double> number_at(const config::Node& node, const char* key) {
  const config::Entry* entry = node.find(key);
  return entry == nullptr ? std::nullopt : config::number_of(entry->value);
}

double duration_in(const fs::path& log, const std::string& name) {
  std::string text = text_of(log);
  text.erase(0, text.find('\n') + 1);  // the command line
  const config::Document document = config::parse(text, name);
  if (const auto stated = number_at(document.root(), "duration_s")) return *stated;
  const config::Entry* trajectory = document.root().find("trajectory");
  if (trajectory != nullptr)
    if (const auto whole = number_at(trajectory->value, "duration_s"))
      return *whole - number_at(document.root(), "start_s").value_or(0);
  throw InputError("generate", "how long " + name +
                                   " lasts stands in its trajectory alone; state duration_s under "
                                   "'set' for an estimate");
}

std::vector<const SweepJob*> evenly_spread(const std::vector<const SweepJob*>& jobs) {
  const std::size_t count = std::min(kPilots, jobs.size());
  std::vector<const SweepJob*> chosen;
  for (std::size_t i = 0; i < count; ++i)
    chosen.push_back(jobs[(2 * i + 1) * jobs.size() / (2 * count)]);
  return chosen;
}

/// Has the program read and print the configurations of the jobs.
std::vector<LaunchJob> print_configurations(const std::vector<const SweepJob*>& jobs,
                                            const fs::path& folder, Launcher& launcher) {
  std::vector<LaunchJob> launches;
  for (const SweepJob* job : jobs)
    launches.push_back(changed_call(*job, folder, "config", {"--print-config"}));
  (void)run_all(launches, launcher);
  return launches;
}

std::vector<double> durations_of(const std::vector<const SweepJob*>& jobs, const fs::path& folder,
                                 Launcher& launcher) {
  std::vector<double> durations_s;
  for (const LaunchJob& launch : print_configurations(jobs, folder, launcher))
    durations_s.push_back(duration_in(launch.log, launch.name));
  return durations_s;
}

struct Piece {
  double events = 0;
  double bytes = 0;
};

Piece measure(const fs::path& folder) {
  const DatasetRecord record = read_dataset_record(folder / "dataset.yaml");
  Piece piece;
  if (record.counts)
    piece.events = static_cast<double>(record.counts->events_on + record.counts->events_off);
  for (const fs::directory_entry& entry : fs::recursive_directory_iterator(folder))
    if (entry.is_regular_file()) piece.bytes += static_cast<double>(entry.file_size());
  return piece;
}

/// The line through what the first `window` and the first two windows took, at `whole`.
double extrapolate(double one, double two, double window_s, double whole_s) {
  return std::max(one, one + (two - one) * (whole_s - window_s) / window_s);
}

struct Unit {
  double size;
  const char* name;
};

/// In the largest of the units (the smallest first) of which there are two at least.
std::string with_spread(const Estimate& estimate, std::initializer_list<Unit> units) {
  Unit unit = *units.begin();
  for (const Unit& larger : units)
    if (estimate.value >= 2 * larger.size) unit = larger;
  return fmt::format("{} +- {} {}", significant(estimate.value / unit.size, 3),
                     significant(estimate.spread / unit.size, 2), unit.name);
}

}  // namespace

Estimate scaled_estimate(const std::vector<double>& sample, std::size_t count) {
  const auto n = static_cast<double>(sample.size());
  const double mean = std::accumulate(sample.begin(), sample.end(), 0.0) / n;
  Estimate estimate{mean * static_cast<double>(count), 0};
  if (sample.size() < 2 || sample.size() == count) return estimate;
  double squares = 0;
  for (const double value : sample) squares += (value - mean) * (value - mean);
  const double error = student_95(sample.size() - 1) * std::sqrt(squares / (n - 1) / n);
  return {estimate.value, error * static_cast<double>(count)};
}

void check_configurations(const std::vector<const SweepJob*>& jobs, Launcher& launcher) {
  const ScratchFolder folder;
  (void)print_configurations(evenly_spread(jobs), folder.path(), launcher);
}

CalibrationRun run_calibration(const std::vector<const SweepJob*>& jobs, Launcher& launcher) {
  const auto start = std::chrono::steady_clock::now();
  const ScratchFolder folder;
  const std::vector<const SweepJob*> chosen = evenly_spread(jobs);
  const std::vector<double> durations_s = durations_of(chosen, folder.path(), launcher);
  const double shortest_s = *std::min_element(durations_s.begin(), durations_s.end());
  const double window_s = std::min(kWindowS, shortest_s / 2);
  std::vector<LaunchJob> launches;
  for (const SweepJob* job : chosen)
    for (const int windows : {1, 2})
      launches.push_back(
          changed_call(*job, folder.path(), fmt::format("{}", windows),
                       {"-q", "--set", fmt::format("duration_s={}", windows * window_s)}));
  const std::vector<double> wall_s = run_all(launches, launcher);
  std::vector<double> events, bytes, core_s;
  for (std::size_t i = 0; i < chosen.size(); ++i) {
    const fs::path parent = folder.path() / chosen[i]->name;
    const Piece one = measure(parent / "1"), two = measure(parent / "2");
    events.push_back(extrapolate(one.events, two.events, window_s, durations_s[i]));
    bytes.push_back(extrapolate(one.bytes, two.bytes, window_s, durations_s[i]));
    core_s.push_back(extrapolate(wall_s[2 * i], wall_s[2 * i + 1], window_s, durations_s[i]));
  }
  const std::chrono::duration<double> cost = std::chrono::steady_clock::now() - start;
  return {chosen.size(),
          window_s,
          cost.count(),
          scaled_estimate(durations_s, jobs.size()).value,
          scaled_estimate(events, jobs.size()),
          scaled_estimate(bytes, jobs.size()),
          scaled_estimate(core_s, jobs.size())};
}

std::string calibration_text(const CalibrationRun& pilot, std::size_t count, int parallel_jobs) {
  const Estimate wall_s{pilot.core_s.value / parallel_jobs, pilot.core_s.spread / parallel_jobs};
  const std::string events =
      with_spread(pilot.events, {{1e3, "thousand"}, {1e6, "million"}, {1e9, "billion"}});
  const std::string bytes = with_spread(pilot.bytes, {{1e6, "MB"}, {1e9, "GB"}, {1e12, "TB"}});
  const std::string time = with_spread(wall_s, {{1, "s"}, {60, "min"}, {3600, "h"}});
  return fmt::format(
      "estimate for {} datasets, {} s of recording:\n  events  {}\n  disk    {}\n"
      "  time    {}, {} at a time on this machine\n"
      "It is drawn from a pilot of {:.1f} s: the first {:.3g} s and {:.3g} s of {} of them, "
      "continued "
      "as a straight line.\n"
      "+- is the 95 % interval that the differences between these datasets leave. How much a "
      "motion "
      "changes later on, and\nhow busy the machine will be, the pilot does not know.\n",
      count, significant(pilot.duration_s, 3), events, bytes, time, parallel_jobs, pilot.cost_s,
      pilot.window_s, 2 * pilot.window_s, pilot.datasets);
}

}  // namespace saccade
