#include "eval/sweep/plan/calibration_run.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <initializer_list>
#include <iterator>
#include <numeric>
#include <optional>
#include <stdexcept>
#include <utility>

#include "core/config/convert.h"
#include "core/config/document.h"
#include "core/error.h"
#include "core/io/dataset/dataset_record.h"
#include "core/io/files/scratch_folder.h"
#include "core/stopwatch.h"
#include "eval/metrics/statistics.h"
#include "eval/table/number_text.h"

namespace saccade {
namespace {

namespace fs = std::filesystem;
using Words = std::vector<std::string>;

constexpr std::size_t kCalibratedDatasets = 8;
constexpr double kWindowS = 0.025;

std::string text_of(const fs::path& file) {
  std::ifstream stream(file);
  return {std::istreambuf_iterator<char>(stream), {}};
}

/// Runs the jobs one at a time; the wall time of each [s].
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

/// The command of a simulation with another output folder and additional arguments.
LaunchJob modified_job(const SweepJob& job, const fs::path& folder, const std::string& part,
                       const Words& more) {
  Words words = job.commands.at(0);
  const fs::path output = folder / job.name / part;
  const auto option = std::find(words.begin(), words.end(), "-o");
  *(option + 1) = output.string();
  words.insert(words.end(), more.begin(), more.end());
  return {job.name, {words}, folder / job.name / (part + ".txt"), {}};
}

/// The number at a key; nullopt for `~` or a missing key.
std::optional<double> number_at(const config::Node& node, const char* key) {
  const config::Entry* entry = node.find(key);
  return entry == nullptr ? std::nullopt : config::number_of(entry->value);
}

/// The duration that --print-config printed into a log [s].
double duration_in(const fs::path& log, const std::string& name) {
  std::string text = text_of(log);
  text.erase(0, text.find('\n') + 1);  // the command line
  const config::Document document = config::parse(text, name);
  if (const auto stated = number_at(document.root(), "duration_s")) return *stated;
  const config::Entry* trajectory = document.root().find("trajectory");
  if (trajectory != nullptr)
    if (const auto whole = number_at(trajectory->value, "duration_s"))
      return *whole - number_at(document.root(), "start_s").value_or(0);
  throw InputError("generate", "the duration of " + name +
                                   " follows from its trajectory alone; state duration_s under "
                                   "'set' to get an estimate");
}

std::vector<const SweepJob*> evenly_spaced(const std::vector<const SweepJob*>& jobs) {
  const std::size_t count = std::min(kCalibratedDatasets, jobs.size());
  std::vector<const SweepJob*> chosen;
  for (std::size_t i = 0; i < count; ++i)
    chosen.push_back(jobs[(2 * i + 1) * jobs.size() / (2 * count)]);
  return chosen;
}

/// Lets the program read and print the configurations of the jobs.
std::vector<LaunchJob> print_configurations(const std::vector<const SweepJob*>& jobs,
                                            const fs::path& folder, Launcher& launcher) {
  std::vector<LaunchJob> launches;
  for (const SweepJob* job : jobs)
    launches.push_back(modified_job(*job, folder, "config", {"--print-config"}));
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

double events_in(const fs::path& folder) {
  const DatasetRecord record = read_dataset_record(folder / "dataset.yaml");
  return record.counts ? static_cast<double>(record.counts->events_on + record.counts->events_off)
                       : 0;
}

double bytes_in(const fs::path& folder) {
  double bytes = 0;
  for (const fs::directory_entry& entry : fs::recursive_directory_iterator(folder))
    if (entry.is_regular_file()) bytes += static_cast<double>(entry.file_size());
  return bytes;
}

/// The line through the costs of one window and of two windows, at `whole_s`.
double extrapolate(double one, double two, double window_s, double whole_s) {
  return std::max(one, one + (two - one) * (whole_s - window_s) / window_s);
}

/// In the largest unit (the smallest first) in which the value is at least 2.
std::string with_spread(const Estimate& estimate,
                        std::initializer_list<std::pair<double, const char*>> units) {
  auto [size, name] = *units.begin();
  for (const auto& [larger, larger_name] : units)
    if (estimate.value >= 2 * larger) {
      size = larger;
      name = larger_name;
    }
  return fmt::format("{} +- {} {}", significant(estimate.value / size, 3),
                     significant(estimate.spread / size, 2), name);
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
  (void)print_configurations(evenly_spaced(jobs), folder.path(), launcher);
}

CalibrationRun run_calibration(const std::vector<const SweepJob*>& jobs, Launcher& launcher) {
  const Stopwatch stopwatch;
  const ScratchFolder folder;
  const std::vector<const SweepJob*> chosen = evenly_spaced(jobs);
  const std::vector<double> durations_s = durations_of(chosen, folder.path(), launcher);
  const double shortest_s = *std::min_element(durations_s.begin(), durations_s.end());
  const double window_s = std::min(kWindowS, shortest_s / 2);
  std::vector<LaunchJob> launches;
  for (const SweepJob* job : chosen)
    for (const int windows : {1, 2})
      launches.push_back(
          modified_job(*job, folder.path(), fmt::format("{}", windows),
                       {"-q", "--set", fmt::format("duration_s={}", windows * window_s)}));
  const std::vector<double> wall_s = run_all(launches, launcher);
  std::vector<double> events, bytes, core_s;
  for (std::size_t i = 0; i < chosen.size(); ++i) {
    const fs::path parent = folder.path() / chosen[i]->name;
    const auto whole = [&](double one, double two) {
      return extrapolate(one, two, window_s, durations_s[i]);
    };
    events.push_back(whole(events_in(parent / "1"), events_in(parent / "2")));
    bytes.push_back(whole(bytes_in(parent / "1"), bytes_in(parent / "2")));
    core_s.push_back(whole(wall_s[2 * i], wall_s[2 * i + 1]));
  }
  return {chosen.size(),
          window_s,
          stopwatch.seconds(),
          scaled_estimate(durations_s, jobs.size()).value,
          scaled_estimate(events, jobs.size()),
          scaled_estimate(bytes, jobs.size()),
          scaled_estimate(core_s, jobs.size())};
}

std::string calibration_text(const CalibrationRun& calibration, std::size_t count,
                             int parallel_jobs) {
  const Estimate wall_s{calibration.core_s.value / parallel_jobs,
                        calibration.core_s.spread / parallel_jobs};
  const std::string events =
      with_spread(calibration.events, {{1e3, "thousand"}, {1e6, "million"}, {1e9, "billion"}});
  const std::string bytes =
      with_spread(calibration.bytes, {{1e6, "MB"}, {1e9, "GB"}, {1e12, "TB"}});
  const std::string time = with_spread(wall_s, {{1, "s"}, {60, "min"}, {3600, "h"}});
  return fmt::format(
      "estimate for {} datasets, {} s of recording:\n  events  {}\n  disk    {}\n"
      "  time    {}, {} at a time on this machine\n"
      "The estimate comes from a calibration run of {:.1f} s: {} of the datasets were simulated "
      "for "
      "{:.3g} s and\nfor {:.3g} s and extrapolated linearly. +- is the 95 % confidence interval "
      "over "
      "the datasets. It does not\ninclude changes of the motion later in a recording, or other "
      "load "
      "on the machine.\n",
      count, significant(calibration.duration_s, 3), events, bytes, time, parallel_jobs,
      calibration.cost_s, calibration.datasets, calibration.window_s, 2 * calibration.window_s);
}

}  // namespace saccade
