#include "eval/sweep/launch/slurm_options.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace saccade {
namespace {

/// Nodes differ in speed, and recordings in their events.
constexpr double kTimeMargin = 3;
constexpr double kMemoryMargin = 1.5;
/// Starting a program on a busy node, and its libraries.
constexpr double kLeastMinutes = 2;
constexpr double kLeastMemoryMb = 500;

/// A whole number; what is one but for rounding stays.
double whole(double value) { return std::ceil(value - 1e-6); }

double rounded_up(double value) {
  const double steps = std::ceil(std::log(value) / std::log(std::numbers::sqrt2) - 1e-9);
  return std::pow(std::numbers::sqrt2, steps);
}

}  // namespace

SlurmRequest SlurmRequest::doubled() const {
  SlurmRequest twice = *this;
  if (twice.minutes) *twice.minutes *= 2;
  if (twice.memory_mb) *twice.memory_mb *= 2;
  return twice;
}

std::vector<std::string> sbatch_options(const SlurmOptions& options, int threads,
                                        const SlurmRequest& request) {
  std::vector<std::string> words{"--nodes=1", "--ntasks=1", "--no-requeue"};
  words.push_back(threads == 0 ? "--exclusive" : fmt::format("--cpus-per-task={}", threads));
  words.insert(words.end(), options.options.begin(), options.options.end());
  // A task runs several jobs one after another: their times add up.
  if (request.minutes)
    words.push_back(fmt::format("--time={:.0f}", whole(*request.minutes * options.jobs_per_task)));
  if (request.memory_mb) words.push_back(fmt::format("--mem={:.0f}M", whole(*request.memory_mb)));
  return words;
}

SlurmRequest request_like(double wall_s, const std::optional<double>& memory_mb) {
  SlurmRequest request;
  request.minutes = rounded_up(std::max(kLeastMinutes, kTimeMargin * wall_s / 60));
  if (memory_mb) request.memory_mb = rounded_up(kLeastMemoryMb + kMemoryMargin * *memory_mb);
  return request;
}

}  // namespace saccade
