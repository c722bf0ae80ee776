#include "tests/bench/study/ablation.h"

#include <array>
#include <chrono>
#include <cstdio>
#include <vector>

#include "simulator/sensor/event_camera.h"
#include "simulator/sensor/frame_camera.h"
#include "tests/support/brute_force.h"

namespace saccade::study {
namespace {

constexpr int kCropWidth = 24;
constexpr int kCropHeight = 16;
constexpr std::array<double, 7> kLambdas_px{1, 0.5, 0.2, 0.1, 0.05, 0.02, 0.01};

/// A part of the image, with what is truly to be seen in it.
struct Crop {
  int x0, y0;
  Events truth;

  [[nodiscard]] Events cut(const Events& events) const {
    Events inside;
    for (Event event : events) {
      const int x = event.x - x0;
      const int y = event.y - y0;
      if (x < 0 || x >= kCropWidth || y < 0 || y >= kCropHeight) continue;
      event.x = static_cast<std::uint16_t>(x);
      event.y = static_cast<std::uint16_t>(y);
      inside.push_back(event);
    }
    return inside;
  }
};

std::vector<Crop> make_crops(const Scenario& scenario, const EventOptions& options) {
  constexpr std::array<std::array<double, 2>, 3> kCentres{{{0.25, 0.3}, {0.5, 0.55}, {0.8, 0.7}}};
  std::vector<Crop> crops;
  for (const auto& [x, y] : kCentres) {
    PinholeCamera camera = scenario.config.camera;
    Crop crop{static_cast<int>(x * camera.width) - kCropWidth / 2,
              static_cast<int>(y * camera.height) - kCropHeight / 2,
              {}};
    camera.width = kCropWidth;
    camera.height = kCropHeight;
    camera.cx -= crop.x0;
    camera.cy -= crop.y0;
    crop.truth = testing::brute_force(scenario.scene, scenario.motion, camera, options, 5e-6);
    crops.push_back(std::move(crop));
  }
  return crops;
}

template <class Camera>
void print_run(const char* name, double lambda_px, const Scenario& scenario,
               const EventOptions& options, const std::vector<Crop>& crops) {
  Events events;
  const auto start = std::chrono::steady_clock::now();
  Camera camera(scenario.scene, scenario.motion, scenario.config.camera, options);
  camera.record(scenario.motion.end_s(), [&](std::span<const SensedEvent> some, double) {
    for (const SensedEvent& event : some) events.push_back(event.event());
  });
  const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - start;
  std::size_t truth = 0, found = 0, at_10_us = 0, at_1_us = 0;
  for (const Crop& crop : crops) {
    const Events inside = crop.cut(events);
    truth += crop.truth.size();
    found += inside.size();
    at_10_us += testing::count_pairs(inside, crop.truth, 10'000);
    at_1_us += testing::count_pairs(inside, crop.truth, 1'000);
  }
  const auto share = [](std::size_t part, std::size_t whole) {
    return static_cast<double>(part) / static_cast<double>(whole);
  };
  const EventStatistics statistics = camera.statistics();
  std::printf("%s %g %zu %.3f %.3f %.5f %.5f %.5f %.5f %.3f\n", name, lambda_px, events.size(),
              share(statistics.rays, events.size()),
              share(statistics.surface_samples, events.size()), share(at_10_us, truth),
              share(at_10_us, found), share(at_1_us, truth), share(at_1_us, found),
              elapsed.count());
  std::fflush(stdout);
}

}  // namespace

void print_ablation(const Scenario& scenario) {
  EventOptions options = scenario.config.events;
  options.noise = {};
  options.timestamp_unit = TimestampUnit::kNanoseconds;
  const std::vector<Crop> crops = make_crops(scenario, options);
  std::printf(
      "# sampling lambda_px events rays_per_event samples_per_event recall_10us "
      "precision_10us recall_1us precision_1us seconds\n");
  print_run<EventCamera>("asynchronous", 0, scenario, options, crops);
  for (const double lambda_px : kLambdas_px) {
    options.frames_lambda_px = lambda_px;
    print_run<FrameCamera>("frames", lambda_px, scenario, options, crops);
  }
}

}  // namespace saccade::study
