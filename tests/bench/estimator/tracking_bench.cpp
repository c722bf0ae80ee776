#include <benchmark/benchmark.h>

#include <algorithm>
#include <span>

#include "estimator/tracking/edges/edge_tracker.h"
#include "tests/support/planar_world.h"

namespace saccade {
namespace {

using testing::corner_motion;
using testing::corner_world;
using testing::PlanarWorld;

/// A corner of textured walls at the DAVIS's 240 x 180 and its events of 50 ms.
struct Recording {
  PlanarWorld world = corner_world(240, 180);
  PinholeCamera camera = world.camera();
  MapPoints map = extract_map(world.log_intensity({}), world.depth({}), camera, {});
  Events events = world.simulate(corner_motion, 0, 0.05, 1e-3, 0.15);
};

const Recording& recording() {
  static const Recording recording;
  return recording;
}

void items_per_second(benchmark::State& state, std::size_t count) {
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(count));
}

void extract(benchmark::State& state) {
  const ImageF log_intensity = recording().world.log_intensity({});
  const ImageF depth = recording().world.depth({});
  for (auto _ : state)
    benchmark::DoNotOptimize(extract_map(log_intensity, depth, recording().camera, {}));
}
BENCHMARK(extract)->Unit(benchmark::kMicrosecond);

/// Argument: 0 nearest, 1 bilinear splats.
void draw_template(benchmark::State& state) {
  TemplateOptions options;
  options.bilinear = state.range(0) != 0;
  TemplateDrawer drawer(recording().camera, options, recording().map);
  for (auto _ : state) benchmark::DoNotOptimize(drawer.draw({}).data());
  items_per_second(state, recording().map.size());
}
BENCHMARK(draw_template)->Arg(0)->Arg(1)->Unit(benchmark::kMicrosecond);

/// Argument: taps.
void blur(benchmark::State& state) {
  const int size = static_cast<int>(state.range(0));
  PaddedImage in(240, 180, size / 2);
  for (std::size_t i = 0; i < in.pixels.size(); ++i) in.pixels[i] = i % 7 == 0 ? 1.0F : 0.0F;
  PaddedImage out(240, 180, size / 2);
  GaussianBlur gaussian(size, 1.1);
  for (auto _ : state) {
    gaussian.apply(in, out);
    benchmark::ClobberMemory();
  }
  items_per_second(state, 240 * 180);
}
BENCHMARK(blur)->Arg(3)->Arg(5)->Arg(9)->Arg(15)->Unit(benchmark::kMicrosecond);

/// Clears and draws one frame. Arguments: events, lens distortion or not.
void event_frame(benchmark::State& state) {
  PinholeCamera camera = recording().camera;
  if (state.range(1) != 0) camera.distortion[0] = -0.3;
  EventFrame frame(camera);
  const auto count = std::min(static_cast<std::size_t>(state.range(0)), recording().events.size());
  const std::span<const Event> events(recording().events.data(), count);
  for (auto _ : state) {
    frame.clear();
    frame.draw(events);
    benchmark::ClobberMemory();
  }
  items_per_second(state, count);
}
BENCHMARK(event_frame)->Args({2000, 0})->Args({2000, 1})->Unit(benchmark::kMicrosecond);

/// One Gauss-Newton step. Arguments: samples, J^T J of the samples (1) or of the template (0).
void lucas_kanade_iteration(benchmark::State& state) {
  AlignOptions options;
  options.samples = static_cast<int>(state.range(0));
  options.iterations = 1;
  options.sampled_hessian = state.range(1) != 0;
  TemplateDrawer drawer(recording().camera, {}, recording().map);
  TemplateAligner aligner(options, recording().camera);
  aligner.set_template(drawer.draw({}));
  EventFrame frame(recording().camera);
  frame.draw(
      std::span(recording().events).first(std::min<std::size_t>(4000, recording().events.size())));
  std::uint64_t draw = 0;
  for (auto _ : state)
    benchmark::DoNotOptimize(aligner.align(frame, {}, Matrix6::Zero(), {}, 1, draw++));
  items_per_second(state, static_cast<std::size_t>(options.samples));
}
BENCHMARK(lucas_kanade_iteration)->ArgsProduct({{50, 500}, {0, 1}})->Unit(benchmark::kMicrosecond);

EdgeTrackerOptions setting(bool fast) {
  EdgeTrackerOptions options;
  if (!fast) return options;
  options.event_frame.event_map_ratio = 0.15;
  options.templates.redraw_px = 4;
  options.align.samples = 50;
  options.align.iterations = 5;
  options.align.averaging_from = 0;
  options.motion.prediction = MotionModelOptions::Prediction::kConstantVelocity;
  return options;
}

/// The whole recording. Argument: 0 accurate, 1 fast. `s_per_frame` is the time of one pose.
void track(benchmark::State& state) {
  EdgeTracker tracker(setting(state.range(0) != 0), recording().camera, recording().map, {}, 1);
  std::size_t frames = 0;
  for (auto _ : state) {
    tracker.reset(0, corner_motion(0));
    frames += tracker.track({recording().events}).size();
  }
  items_per_second(state, recording().events.size());
  state.counters["s_per_frame"] = benchmark::Counter(
      static_cast<double>(frames), benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
}
BENCHMARK(track)->Arg(0)->Arg(1)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace saccade
