#include "simulator/sensor/event_camera.h"

#include <benchmark/benchmark.h>

#include "simulator/sensor/image_renderer.h"
#include "tests/support/closed_form_plane.h"
#include "tests/unit/simulator/scene/plane_scene.h"

namespace saccade {
namespace {

using testing::ClosedFormPlane;

/// Events per second, and rays and surface samples per event.
void record(benchmark::State& state, const EventOptions& options) {
  ClosedFormPlane plane = ClosedFormPlane::smooth(240, 180);
  plane.duration_s = 0.2;
  plane.camera.fx = plane.camera.fy = 200;
  const Scene scene = testing::scene_of(plane);
  const Spline motion = plane.motion();
  std::int64_t events = 0;
  EventStatistics statistics;
  for (auto _ : state) {
    EventCamera camera(scene, motion, plane.camera, options);
    camera.record(plane.duration_s, [&](std::span<const SensedEvent> some, double) {
      events += static_cast<std::int64_t>(some.size());
    });
    statistics.add(camera.statistics());
  }
  const auto per_event = [&](std::uint64_t count) {
    return static_cast<double>(count) / static_cast<double>(events);
  };
  state.SetItemsProcessed(events);
  state.counters["rays_per_event"] = per_event(statistics.rays);
  state.counters["samples_per_event"] = per_event(statistics.surface_samples);
}

/// At a contrast of range(0) / 100.
void record_events(benchmark::State& state) {
  EventOptions options;
  options.contrast.on = options.contrast.off = 0.01 * static_cast<double>(state.range(0));
  record(state, options);
}
BENCHMARK(record_events)->Arg(15)->Arg(50)->Unit(benchmark::kMillisecond)->UseRealTime();

/// At a contrast of 0.15 behind a low pass with two poles and a cutoff of range(0) Hz.
void record_filtered_events(benchmark::State& state) {
  EventOptions options;
  options.contrast.on = options.contrast.off = 0.15;
  options.noise.bandwidth.cutoff_hz = static_cast<double>(state.range(0));
  options.noise.bandwidth.order = 2;
  record(state, options);
}
BENCHMARK(record_filtered_events)
    ->Arg(300)
    ->Arg(3000)
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime();

/// A grey frame of 240 x 180 px, pixels per second.
void render_frame(benchmark::State& state) {
  const ClosedFormPlane plane = ClosedFormPlane::smooth(240, 180);
  const Scene scene = testing::scene_of(plane);
  const ImageRenderer renderer(scene, plane.camera, static_cast<int>(state.range(0)));
  const std::vector<StampedPose> pose{{0.1, plane.motion().pose(0.1)}};
  for (auto _ : state) benchmark::DoNotOptimize(renderer.radiance(pose));
  state.SetItemsProcessed(state.iterations() * 240 * 180);
}
BENCHMARK(render_frame)->Arg(1)->Arg(4)->Unit(benchmark::kMillisecond)->UseRealTime();

void evaluate_pose(benchmark::State& state) {
  const Spline motion = ClosedFormPlane::smooth(8, 8).motion();
  const SplineTable table(motion, 0, 0.02);
  double t = 0;
  for (auto _ : state) {
    t = t < 0.0199 ? t + 1e-7 : 0;
    benchmark::DoNotOptimize(table.at(t));
  }
}
BENCHMARK(evaluate_pose);

}  // namespace
}  // namespace saccade
