#include "estimator/reconstruction/reconstruction_module.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <vector>

#include "core/config/config.h"
#include "core/error.h"
#include "core/parallel.h"
#include "core/progress.h"
#include "estimator/depth/depth_windows.h"
#include "estimator/reconstruction/depth_source.h"
#include "estimator/reconstruction/reconstruction_config.h"
#include "estimator/reconstruction/reconstruction_output.h"
#include "estimator/run_input.h"
#include "estimator/run_writer.h"
#include "estimator/stage_clock.h"

namespace saccade {
namespace {

constexpr double kContrast = 0.2;  ///< where neither the configuration nor the dataset states one

/// Of the grey frame nearest to the middle of the window and within it; the middle without one.
double time_of_frame(const Dataset& dataset, double start_s, double end_s) {
  const double middle_s = (start_s + end_s) / 2;
  double best_s = middle_s;
  bool is_found = false;
  for (const StampedFile& frame : dataset.frames()) {
    if (frame.t_s < start_s || frame.t_s > end_s) continue;
    if (is_found && std::abs(frame.t_s - middle_s) >= std::abs(best_s - middle_s)) continue;
    best_s = frame.t_s;
    is_found = true;
  }
  return best_s;
}

double reference_time(const ViewOptions& options, const Dataset& dataset, double start_s,
                      double end_s) {
  switch (options.reference) {
    case ViewOptions::Reference::kStart:
      return start_s;
    case ViewOptions::Reference::kMiddle:
      return (start_s + end_s) / 2;
    case ViewOptions::Reference::kEnd:
      return end_s;
    case ViewOptions::Reference::kFrame:
      return time_of_frame(dataset, start_s, end_s);
  }
  return start_s;
}

std::vector<ReconstructionWindow> make_windows(std::span<const Event> events,
                                               const Trajectory& trajectory, const Dataset& dataset,
                                               const ReconstructionConfig& config) {
  DepthWindowOptions cut;
  cut.by = config.window.by == ViewOptions::By::kTime ? DepthWindowOptions::By::kTime
                                                      : DepthWindowOptions::By::kEvents;
  cut.duration_s = config.window.duration_s;
  cut.events = config.window.events;
  const DatasetFacts& facts = dataset.facts();
  std::vector<ReconstructionWindow> windows;
  for (const DepthWindow& part : cut_windows(events, trajectory, cut)) {
    ReconstructionWindow window;
    window.events = part.events;
    window.trajectory = &trajectory;
    window.reference_s =
        reference_time(config.window, dataset, seconds_from_ns(part.events.front().t_ns),
                       seconds_from_ns(part.events.back().t_ns));
    window.contrast_on = config.contrast_on.value_or(facts.contrast_on.value_or(kContrast));
    window.contrast_off = config.contrast_off.value_or(facts.contrast_off.value_or(kContrast));
    windows.push_back(std::move(window));
  }
  return windows;
}

/// Sums over the windows. With several threads they are processor seconds.
std::vector<std::pair<std::string, double>> sum_of_stages(
    const std::vector<Reconstruction>& results) {
  std::vector<std::pair<std::string, double>> sums = results.front().stages_s;
  for (std::size_t i = 1; i < results.size(); ++i)
    for (std::size_t j = 0; j < sums.size(); ++j) sums[j].second += results[i].stages_s[j].second;
  return sums;
}

/// All windows, `repeat` times; the last results.
std::vector<Reconstruction> reconstruct(const ImageEstimator& estimator,
                                        const std::vector<ReconstructionWindow>& windows,
                                        int repeat, RunTiming& timing) {
  std::vector<Reconstruction> results(windows.size());
  Progress progress("reconstruction", timing.events * static_cast<std::size_t>(repeat), "events");
  for (int i = 0; i < repeat; ++i) {
    double wall_s = 0;
    {
      const StageClock clock(wall_s);
      parallel_for(windows.size(), [&](std::size_t k) {
        results[k] = estimator.reconstruct(windows[k]);
        progress.add(windows[k].events.size());
      });
    }
    timing.wall_s.push_back(wall_s);
  }
  timing.stages_s = sum_of_stages(results);
  return results;
}

/// The first window from fewer events, as in thesis figs. 8.14 and 8.15.
std::vector<GrowthPicture> grow(const ImageEstimator& estimator, const ReconstructionWindow& window,
                                const std::vector<std::int64_t>& counts) {
  std::vector<GrowthPicture> pictures(counts.size());
  parallel_for(counts.size(), [&](std::size_t i) {
    ReconstructionWindow part = window;
    const auto count = std::min(window.events.size(),
                                static_cast<std::size_t>(std::max<std::int64_t>(counts[i], 1)));
    part.events = window.events.first(count);
    pictures[i] = {count, estimator.reconstruct(part).log_image};
  });
  return pictures;
}

}  // namespace

RunSummary run_reconstruction(const RunRequest& request) {
  ReconstructionConfig config = config::read<ReconstructionConfig>(request.config);
  if (request.seed) config.seed = *request.seed;
  check(request);
  RunWriter writer(request);

  RunTiming timing;
  const Dataset dataset = Dataset::open(request.dataset);
  Trajectory trajectory;
  Events loaded;
  {
    const StageClock clock(timing.io_s);
    trajectory = load_poses(request, dataset);
    loaded = load_events(request, dataset);
  }
  const std::span<const Event> events = within(loaded, trajectory);
  if (events.empty())
    throw InputError(dataset.folder().string(), "holds no events within the time of the poses");
  auto windows = make_windows(events, trajectory, dataset, config);
  timing.events = events.size();
  timing.sequence_s = seconds_from_ns(events.back().t_ns - events.front().t_ns);
  {
    const StageClock clock(timing.io_s);
    const DepthSource depth(dataset, request.depth_from, trajectory, config.depth);
    for (ReconstructionWindow& window : windows) window.scene = depth.scene_at(window.reference_s);
  }
  const auto estimator = make_image_estimator(config, dataset.camera());
  const auto results = reconstruct(*estimator, windows, request.repeat, timing);
  const auto growth = grow(*estimator, windows.front(), config.growth);
  {
    const StageClock clock(timing.io_s);
    write_reconstruction(writer.path(), windows, results, growth);
  }
  const RunRecord::Window window =
      window_of(request, seconds_from_ns(loaded.front().t_ns), seconds_from_ns(loaded.back().t_ns));
  writer.finish("reconstruct", request, dataset, window, config.seed, config::print(config),
                timing);

  RunSummary summary;
  summary.events = events.size();
  summary.views = windows.size();
  summary.wall_s = median(timing.wall_s);
  return summary;
}

std::string print_reconstruction_config(const config::Document& document) {
  return config::print_documented(config::read<ReconstructionConfig>(document));
}

}  // namespace saccade
