// Measures the event simulation; tests/bench/study/run draws the plots of docs/performance.md from
// it.
//   sampling_study ablation CONFIG [KEY=VALUE...]
//   sampling_study speed RUNS CONFIG [KEY=VALUE...]
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <filesystem>
#include <string>
#include <vector>

#include "core/error.h"
#include "core/progress.h"
#include "simulator/simulate.h"
#include "tests/bench/study/ablation.h"
#include "tests/bench/study/raw_embree.h"

namespace saccade::study {
namespace {

/// Times of the events of whole simulations, written to a folder that is removed; the middle one of
/// `runs`, the shortest and the longest.
void print_speed(int runs, const Scenario& scenario) {
  SimulationConfig config = scenario.config;
  config.frames.rate_hz = 0;
  config.groundtruth.depth_rate_hz = 0;
  const std::filesystem::path folder =
      std::filesystem::temp_directory_path() / ("sampling_study_" + std::to_string(std::rand()));
  std::vector<double> seconds;
  double events = 0;
  EventStatistics statistics;
  for (int k = 0; k < runs; ++k) {
    const CameraReport report = simulate(config, folder / "run").cameras.front();
    std::filesystem::remove_all(folder);
    seconds.push_back(report.events_s);
    events = static_cast<double>(report.event_count());
    statistics = report.events;
  }
  std::sort(seconds.begin(), seconds.end());
  const double median_s = seconds[seconds.size() / 2];
  const RayRates rates = measure_ray_rates(scenario);
  std::printf(
      "# "
      "width\ttriangles\tevents\trays_per_event\tlooks_per_event\tseconds\tMevents_per_s\tlowest\t"
      "highest\tMrays_per_s\tMvisible_per_s\tMembree_per_s\n");
  const auto rays = static_cast<double>(statistics.rays);
  std::printf("%d\t%zu\t%.0f\t%.3f\t%.3f\t%.3f\t%.3f\t%.3f\t%.3f\t%.2f\t%.1f\t%.1f\n",
              config.camera.width, scenario.scene.triangle_count(), events, rays / events,
              static_cast<double>(statistics.surface_looks) / events, median_s,
              1e-6 * events / median_s, 1e-6 * events / seconds.back(),
              1e-6 * events / seconds.front(), 1e-6 * rays / median_s, 1e-6 * rates.visible,
              1e-6 * rates.embree);
}

int usage() {
  std::fprintf(stderr,
               "usage: sampling_study ablation CONFIG [KEY=VALUE...]\n"
               "       sampling_study speed RUNS CONFIG [KEY=VALUE...]\n");
  return 2;
}

int run(const std::vector<std::string>& arguments) {
  set_progress_quiet(true);
  const auto load = [&](std::size_t first) {
    return Scenario(arguments[first], std::span(arguments).subspan(first + 1));
  };
  if (arguments.size() >= 2 && arguments[0] == "ablation") {
    print_ablation(load(1));
  } else if (arguments.size() >= 3 && arguments[0] == "speed" && std::stoi(arguments[1]) > 0) {
    print_speed(std::stoi(arguments[1]), load(2));
  } else {
    return usage();
  }
  return 0;
}

}  // namespace
}  // namespace saccade::study

int main(int argc, char** argv) {
  try {
    return saccade::study::run({argv + 1, argv + argc});
  } catch (const std::exception& error) {
    std::fprintf(stderr, "sampling_study: %s\n", error.what());
    return 1;
  }
}
