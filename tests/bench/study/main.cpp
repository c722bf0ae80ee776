// Measures the event simulation; tests/bench/study/run draws the plots of docs/performance.md from
// it.
//   sampling_study ablation CONFIG [KEY=VALUE...]
//   sampling_study speed RUNS CONFIG [KEY=VALUE...]
//   sampling_study record RUNS CONFIG [KEY=VALUE...]
#include <algorithm>
#include <cstdio>
#include <ctime>
#include <exception>
#include <filesystem>
#include <limits>
#include <string>
#include <vector>

#include "core/io/files/scratch_folder.h"
#include "core/process/progress.h"
#include "simulator/recording_loop.h"
#include "simulator/sensor/event_camera.h"
#include "simulator/simulate.h"
#include "tests/bench/study/ablation.h"
#include "tests/bench/study/raw_embree.h"

namespace saccade::study {
namespace {

/// Time of all processors together that sensing the events takes, without writing them: unlike the
/// time on the clock it hardly depends on what else the machine does.
double sensing_processor_s(const Scenario& scenario) {
  const std::clock_t start = std::clock();
  const SimulationConfig& config = scenario.config;
  EventCamera camera(scenario.scene, scenario.motion, config.camera, config.events, config.seed);
  camera.record(scenario.motion.end_s(), [](std::span<const SensedEvent>, double) {});
  return static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
}

/// Times of the events of `runs` whole simulations, which are written to a folder that is removed:
/// the middle one, the shortest and the longest.
void print_speed(int runs, const Scenario& scenario) {
  SimulationConfig config = scenario.config;
  config.frames.rate_hz = 0;
  config.groundtruth.depth_rate_hz = 0;
  const ScratchFolder scratch;
  const std::filesystem::path folder = scratch.path() / "events";
  std::vector<double> seconds;
  double events = 0;
  EventStatistics statistics;
  double processor_s = std::numeric_limits<double>::infinity();
  for (int k = 0; k < runs; ++k) {
    const CameraReport report = simulate(config, folder).cameras.front();
    std::filesystem::remove_all(folder);
    seconds.push_back(report.events_s);
    events = static_cast<double>(report.event_count());
    statistics = report.events;
    processor_s = std::min(processor_s, sensing_processor_s(scenario));
  }
  std::sort(seconds.begin(), seconds.end());
  const double median_s = seconds[seconds.size() / 2];
  const RayRates rates = measure_ray_rates(scenario);
  const auto rays = static_cast<double>(statistics.rays);
  std::printf(
      "# width triangles events rays_per_event samples_per_event seconds least greatest "
      "Mevents_per_s sensing_cpu_s Mevents_per_cpu_s Mrays_per_cpu_s Mvisible_per_cpu_s "
      "Membree_per_cpu_s\n");
  std::printf("%d %zu %.0f %.3f %.3f %.3f %.3f %.3f %.3f %.3f %.3f %.2f %.1f %.1f\n",
              config.camera.width, scenario.scene.triangle_count(), events, rays / events,
              static_cast<double>(statistics.surface_samples) / events, median_s, seconds.front(),
              seconds.back(), 1e-6 * events / median_s, processor_s, 1e-6 * events / processor_s,
              1e-6 * rays / processor_s, 1e-6 * rates.visible, 1e-6 * rates.embree);
}

/// Senses and logs the events again and again, for a profiler.
void record(int runs, const Scenario& scenario) {
  const SimulationConfig& config = scenario.config;
  const ScratchFolder scratch;
  const std::filesystem::path folder = scratch.path() / "events";
  for (int k = 0; k < runs; ++k) {
    EventCamera camera(scenario.scene, scenario.motion, config.camera, config.events, config.seed);
    EventLog log(folder);
    record_into(log, camera, scenario.motion.end_s(), [](double) {});
    std::filesystem::remove_all(folder);
  }
}

int usage() {
  std::fprintf(stderr,
               "usage: sampling_study ablation CONFIG [KEY=VALUE...]\n"
               "       sampling_study speed RUNS CONFIG [KEY=VALUE...]\n"
               "       sampling_study record RUNS CONFIG [KEY=VALUE...]\n");
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
  } else if (arguments.size() >= 3 && arguments[0] == "record" && std::stoi(arguments[1]) > 0) {
    record(std::stoi(arguments[1]), load(2));
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
