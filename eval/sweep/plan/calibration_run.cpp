#include "eval/sweep/plan/calibration_run.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <initializer_list>
#include <iterator>
#include <numbers>
#include <numeric>
#include <optional>
#include <stdexcept>
#include <utility>

#include "core/config/convert.h"
#include "core/config/document.h"
#include "core/error.h"
#include "core/io/dataset/dataset_record.h"
#include "core/io/files/scratch_folder.h"
#include "core/process/progress.h"
#include "core/stopwatch.h"
#include "eval/metrics/statistics.h"
#include "eval/table/number_text.h"

namespace saccade {
namespace {

namespace fs = std::filesystem;
using Words = std::vector<std::string>;

constexpr std::size_t kCheckedDatasets = 8;
constexpr std::size_t kBatch = 8;
constexpr double kWindowS = 0.025;
/// A shorter dataset is simulated as a whole: its beginnings would cost as much.
constexpr double kShortS = 4 * kWindowS;
/// The calibration goes on until the time is known to this share, and ends in any case when it has
/// taken the other share of what it has estimated, at least 20 s and at most five minutes: datasets
/// differ by factors, so that eight of them say little, and for a long generation a better estimate
/// is worth more time, but nobody waits an hour for one.
constexpr double kGoodShare = 0.1, kMostShare = 0.1;
constexpr double kLeastCostS = 20, kMostCostS = 300;

std::string text_of(const fs::path& file) {
  std::ifstream stream(file);
  return {std::istreambuf_iterator<char>(stream), {}};
}

/// Runs the jobs; the wall time of each [s].
std::vector<double> run_all(const std::vector<LaunchJob>& jobs, const LaunchLimits& limits,
                            Launcher& launcher) {
  std::vector<double> wall_s(jobs.size(), 0);
  const auto on_end = [&](std::size_t i, const LaunchResult& result) {
    if (!result.succeeded)
      throw InputError("generate", fmt::format("dataset {} cannot be simulated:\n{}", jobs[i].name,
                                               text_of(jobs[i].log)));
    wall_s[i] = result.wall_s;
  };
  if (!launcher.run(jobs, limits, {on_end, [] {}, [](const std::string&) {}}))
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
  const std::size_t count = std::min(kCheckedDatasets, jobs.size());
  std::vector<const SweepJob*> chosen;
  for (std::size_t i = 0; i < count; ++i)
    chosen.push_back(jobs[(2 * i + 1) * jobs.size() / (2 * count)]);
  return chosen;
}

/// All jobs in an order whose beginnings are spread evenly: multiples of the golden ratio.
std::vector<const SweepJob*> spread_order(const std::vector<const SweepJob*>& jobs) {
  std::vector<const SweepJob*> order;
  std::vector<bool> taken(jobs.size(), false);
  const auto n = static_cast<double>(jobs.size());
  for (std::size_t k = 0; order.size() < jobs.size(); ++k) {
    const double turn = (static_cast<double>(k) + 0.5) * std::numbers::phi;
    auto index = static_cast<std::size_t>(n * (turn - std::floor(turn)));
    while (taken[index]) index = (index + 1) % jobs.size();
    taken[index] = true;
    order.push_back(jobs[index]);
  }
  return order;
}

/// Lets the program read and print the configurations of the jobs.
std::vector<LaunchJob> print_configurations(const std::vector<const SweepJob*>& jobs,
                                            const fs::path& folder, Launcher& launcher) {
  std::vector<LaunchJob> launches;
  for (const SweepJob* job : jobs)
    launches.push_back(modified_job(*job, folder, "config", {"--print-config"}));
  (void)run_all(launches, {1, 1}, launcher);
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

/// What some datasets cost.
struct CalibrationSample {
  std::vector<double> durations_s, events, bytes, core_s;
};

/// Simulates them, short ones as a whole and of others the beginning twice, as many at a time as
/// are to be generated: programs that run beside each other slow each other down.
void add_datasets(const std::vector<const SweepJob*>& jobs, const LaunchLimits& limits,
                  Launcher& launcher, CalibrationSample& sample) {
  const ScratchFolder folder;
  const std::vector<double> durations_s = durations_of(jobs, folder.path(), launcher);
  std::vector<LaunchJob> launches;
  std::vector<std::size_t> first;  // launch of each job
  for (std::size_t i = 0; i < jobs.size(); ++i) {
    first.push_back(launches.size());
    if (durations_s[i] <= kShortS) {
      launches.push_back(modified_job(*jobs[i], folder.path(), "whole", {"-q"}));
      continue;
    }
    for (const int windows : {1, 2})
      launches.push_back(
          modified_job(*jobs[i], folder.path(), fmt::format("{}", windows),
                       {"-q", "--set", fmt::format("duration_s={}", windows * kWindowS)}));
  }
  const std::vector<double> wall_s = run_all(launches, limits, launcher);
  for (std::size_t i = 0; i < jobs.size(); ++i) {
    const fs::path parent = folder.path() / jobs[i]->name;
    sample.durations_s.push_back(durations_s[i]);
    if (durations_s[i] <= kShortS) {
      sample.events.push_back(events_in(parent / "whole"));
      sample.bytes.push_back(bytes_in(parent / "whole"));
      sample.core_s.push_back(wall_s[first[i]]);
      continue;
    }
    const auto whole = [&](double one, double two) {
      return extrapolate(one, two, kWindowS, durations_s[i]);
    };
    sample.events.push_back(whole(events_in(parent / "1"), events_in(parent / "2")));
    sample.bytes.push_back(whole(bytes_in(parent / "1"), bytes_in(parent / "2")));
    sample.core_s.push_back(whole(wall_s[first[i]], wall_s[first[i] + 1]));
  }
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

CalibrationRun run_calibration(const std::vector<const SweepJob*>& jobs, const LaunchLimits& limits,
                               Launcher& launcher) {
  const Stopwatch stopwatch;
  const std::vector<const SweepJob*> order = spread_order(jobs);
  CalibrationSample sample;
  CalibrationRun run;
  for (std::size_t begin = 0; begin < order.size(); begin += kBatch) {
    const auto first = order.begin() + static_cast<std::ptrdiff_t>(begin);
    const std::size_t count = std::min(kBatch, order.size() - begin);
    add_datasets({first, first + static_cast<std::ptrdiff_t>(count)}, limits, launcher, sample);
    run = {sample.core_s.size(),
           kWindowS,
           stopwatch.seconds(),
           scaled_estimate(sample.durations_s, jobs.size()).value,
           scaled_estimate(sample.events, jobs.size()),
           scaled_estimate(sample.bytes, jobs.size()),
           scaled_estimate(sample.core_s, jobs.size())};
    const double whole_s = run.core_s.value / limits.parallel_jobs;
    if (run.core_s.spread <= kGoodShare * run.core_s.value) break;
    if (run.cost_s >= std::clamp(kMostShare * whole_s, kLeastCostS, kMostCostS)) break;
    show_notice(fmt::format("calibrating: {} datasets in {:.0f} s; the time is known to {:.0f} %",
                            run.datasets, run.cost_s,
                            100 * run.core_s.spread / std::max(run.core_s.value, 1e-9)));
  }
  return run;
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
      "The estimate comes from a calibration run of {:.1f} s, in which {} of the datasets were "
      "simulated, {} at\na time: those of up to {:.3g} s as a whole, of others {:.3g} s and {:.3g} "
      "s, "
      "extrapolated linearly. +- is\nthe 95 % confidence interval over the datasets. It does not "
      "include changes of the motion later in a\nrecording, or other load on the machine.\n",
      count, significant(calibration.duration_s, 3), events, bytes, time, parallel_jobs,
      calibration.cost_s, calibration.datasets, parallel_jobs, kShortS, calibration.window_s,
      2 * calibration.window_s);
}

}  // namespace saccade
