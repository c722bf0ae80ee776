#include "core/spline/spline.h"

#include <benchmark/benchmark.h>

#include <cmath>

#include "core/random.h"

namespace saccade {
namespace {

/// Hand-held-like motion, 200 poses a second.
std::vector<StampedPose> samples(double duration_s) {
  std::vector<StampedPose> poses;
  for (int i = 0; i <= static_cast<int>(duration_s * 200); ++i) {
    const double t = i / 200.0;
    poses.push_back({t,
                     {so3_exp({std::sin(3 * t), 0.5 * std::cos(2 * t), 0.3 * t}),
                      {std::sin(t), std::cos(1.3 * t), 0.1 * std::sin(5 * t)}}});
  }
  return poses;
}

/// A few turns of more than a radian per segment, beyond the series of sine and cosine.
Spline coarse_spline() {
  std::vector<StampedPose> poses;
  for (int i = 0; i < 10; ++i) poses.push_back({0.4 * i, {so3_exp({0, 0, 1.7 * i}), {}}});
  for (StampedPose& p : poses)
    p.world_from_camera = {p.world_from_camera.rotation(), {p.t_s, 0, 0}};
  return Spline::interpolate(poses);
}

/// The simulator's pattern: instants a few microseconds apart.
void pose_in_order(benchmark::State& state, const Spline& spline) {
  double t = spline.start_s();
  for (auto _ : state) {
    benchmark::DoNotOptimize(spline.pose(t));
    t += 7e-6;
    if (t > spline.end_s()) t = spline.start_s();
  }
}

void BM_PoseInOrder(benchmark::State& state) {
  pose_in_order(state, Spline::smooth(samples(60), 0.04));
}
BENCHMARK(BM_PoseInOrder);

void BM_PoseInOrderLargeTurns(benchmark::State& state) { pose_in_order(state, coarse_spline()); }
BENCHMARK(BM_PoseInOrderLargeTurns);

template <class Evaluate>
void at_random_times(benchmark::State& state, const Spline& spline, const Evaluate& evaluate) {
  const Random random(1);
  std::vector<double> times;
  for (std::size_t i = 0; i < 4096; ++i) {
    times.push_back(spline.start_s() + random.uniform(0, i) * (spline.end_s() - spline.start_s()));
  }
  std::size_t i = 0;
  for (auto _ : state) {
    benchmark::DoNotOptimize(evaluate(spline, times[i]));
    i = (i + 1) % times.size();
  }
}

void BM_PoseAtRandomTimes(benchmark::State& state) {
  at_random_times(state, Spline::interpolate(samples(60)),
                  [](const Spline& s, double t) { return s.pose(t); });
}
BENCHMARK(BM_PoseAtRandomTimes);

void BM_StateAtRandomTimes(benchmark::State& state) {
  at_random_times(state, Spline::interpolate(samples(60)),
                  [](const Spline& s, double t) { return s.state(t); });
}
BENCHMARK(BM_StateAtRandomTimes);

void BM_Interpolate60s200Hz(benchmark::State& state) {
  const auto poses = samples(60);
  for (auto _ : state) benchmark::DoNotOptimize(Spline::interpolate(poses));
}
BENCHMARK(BM_Interpolate60s200Hz)->Unit(benchmark::kMillisecond);

void BM_Smooth60s200Hz(benchmark::State& state) {
  const auto poses = samples(60);
  for (auto _ : state) benchmark::DoNotOptimize(Spline::smooth(poses, 0.04));
}
BENCHMARK(BM_Smooth60s200Hz)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace saccade
