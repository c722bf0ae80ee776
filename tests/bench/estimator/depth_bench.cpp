#include <benchmark/benchmark.h>

#include <algorithm>
#include <span>
#include <string_view>
#include <vector>

#include "core/process/parallel.h"
#include "estimator/depth/depth_config.h"
#include "estimator/depth/rays/edgel_refiner.h"
#include "estimator/depth/rays/edgel_seeds.h"
#include "estimator/depth/rays/event_rays.h"
#include "estimator/depth/rays/local_planes.h"
#include "estimator/depth/rays/ray_gatherer.h"
#include "estimator/depth/rays/ray_regression.h"
#include "estimator/depth/rays/ray_votes.h"
#include "estimator/depth/thesis/derotated_frame.h"
#include "estimator/depth/thesis/epipolar.h"
#include "estimator/depth/thesis/epipolar_search.h"
#include "estimator/run/view_windows.h"
#include "tests/support/planar_world.h"

namespace saccade {
namespace {

using testing::corner_motion;
using testing::corner_world;
using testing::PlanarWorld;

Trajectory corner_trajectory() {
  std::vector<StampedPose> poses;
  for (int i = 0; i <= 400; ++i) poses.push_back({i * 1e-3, corner_motion(i * 1e-3)});
  return Trajectory(poses);
}

/// A corner of textured walls at the DAVIS's 240 x 180 and its events of 0.4 s.
struct Recording {
  PlanarWorld world = corner_world(240, 180);
  Trajectory trajectory = corner_trajectory();
  Events events = world.simulate(corner_motion, 0, 0.4, 1e-3, 0.15);
  UndistortionTable undistortion{world.camera()};
};

const Recording& recording() {
  static const Recording recording;
  return recording;
}

void items_per_second(benchmark::State& state, std::size_t count) {
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(count));
}

std::span<const Event> some_events() {
  return std::span(recording().events)
      .first(std::min<std::size_t>(12000, recording().events.size()));
}

ImageF frame() {
  const Recording& r = recording();
  const Derotation derotation(r.world.camera(), r.undistortion, r.trajectory, {1, 0, 0, 0});
  ImageF image = derotation.draw(some_events());
  normalise_frame(image);
  return image;
}

void derotate(benchmark::State& state) {
  static_cast<void>(recording());  // made before the clock runs
  for (auto _ : state) benchmark::DoNotOptimize(frame().data());
  items_per_second(state, some_events().size());
}
BENCHMARK(derotate)->Unit(benchmark::kMicrosecond);

/// One keypoint in one frame. Argument: radius of the patch.
void search(benchmark::State& state) {
  const int radius = static_cast<int>(state.range(0));
  const ImageF image = frame();
  const FramePatch reference(image, {120.3, 90.6}, radius);
  const SearchOptions options{.patch_radius_px = radius, .min_alignment = 0, .min_correlation = -1};
  for (auto _ : state)
    benchmark::DoNotOptimize(search_along(reference, image, {121.1, 90.6}, {1, 0}, options));
  items_per_second(state, 1);
}
BENCHMARK(search)->Arg(3)->Arg(5)->Arg(7)->Unit(benchmark::kMicrosecond);

void dlt(benchmark::State& state) {
  for (auto _ : state)
    benchmark::DoNotOptimize(triangulate({0.1, 0.2, 1}, {0.15, 0.2, 1}, {0.1, 0, 0}));
  items_per_second(state, 1);
}
BENCHMARK(dlt)->Unit(benchmark::kMicrosecond);

/// Rays of the whole recording.
void rays(benchmark::State& state) {
  const Recording& r = recording();
  for (auto _ : state)
    benchmark::DoNotOptimize(
        EventRays({r.events, &r.trajectory, 0.2}, r.world.camera(), r.undistortion, 32).size());
  items_per_second(state, r.events.size());
}
BENCHMARK(rays)->Unit(benchmark::kMillisecond);

/// Votes on one plane.
void votes(benchmark::State& state) {
  const Recording& r = recording();
  const EventRays rays({r.events, &r.trajectory, 0.2}, r.world.camera(), r.undistortion, 32);
  Image<Eigen::Vector2f> image(r.world.camera().width, r.world.camera().height,
                               Eigen::Vector2f::Zero());
  for (auto _ : state) {
    vote_vectors(rays, 0, rays.size(), 0.4F, image);
    benchmark::DoNotOptimize(image.data());
  }
  items_per_second(state, rays.size());
}
BENCHMARK(votes)->Unit(benchmark::kMicrosecond);

/// One edge over the whole window: its rays, and the regression.
void regression(benchmark::State& state) {
  const Recording& r = recording();
  const EventRays rays({r.events, &r.trajectory, 0.2}, r.world.camera(), r.undistortion, 32);
  RayGatherer gatherer(rays, {});
  RayNeighbourhood near;
  for (auto _ : state) {
    gatherer.gather({0, 32, 1}, {{120, 90}, {1, 0}, 0.4F}, near);
    benchmark::DoNotOptimize(regress(near, {}).change);
  }
  items_per_second(state, std::max<std::size_t>(near.count, 1));
}
BENCHMARK(regression)->Unit(benchmark::kMicrosecond);

/// All seeds of the whole recording, without and with their refinement.
void seeds(benchmark::State& state) {
  const Recording& r = recording();
  const EventRays rays({r.events, &r.trajectory, 0.2}, r.world.camera(), r.undistortion, 32);
  for (auto _ : state) benchmark::DoNotOptimize(find_seeds(rays, r.world.camera(), {}).seeds.size());
  items_per_second(state, rays.size());
}
BENCHMARK(seeds)->Unit(benchmark::kMillisecond);

void refinement(benchmark::State& state) {
  const Recording& r = recording();
  const EventRays rays({r.events, &r.trajectory, 0.2}, r.world.camera(), r.undistortion, 32);
  const auto found = find_seeds(rays, r.world.camera(), {}).seeds;
  const RefinerOptions options;
  for (auto _ : state) {
    EdgelRefiner refiner(rays, options, {}, r.world.camera());
    EdgelEvents events;
    std::size_t edges = 0;
    for (const EdgelSeed& seed : found) edges += refiner.refine(seed, events) ? 1 : 0;
    benchmark::DoNotOptimize(edges);
  }
  items_per_second(state, found.size());
}
BENCHMARK(refinement)->Unit(benchmark::kMillisecond);

/// One plane through some forty points.
void local_plane(benchmark::State& state) {
  std::vector<EdgePoint> points;
  for (int y = 0; y < 60; y += 2)
    for (int x = 0; x < 60; x += 2)
      points.push_back({static_cast<float>(x), static_cast<float>(y), 0.5F, 0.001F});
  LocalPlanes planes(points, {});
  for (auto _ : state)
    benchmark::DoNotOptimize(planes.fit({30.5F, 30.5F, 0.5F, 0.001F}).inverse_depth);
  items_per_second(state, 1);
}
BENCHMARK(local_plane)->Unit(benchmark::kNanosecond);

/// The whole recording in four windows. Arguments: method, threads.
void depth(benchmark::State& state) {
  DepthConfig config;
  constexpr std::string_view kMethods[] = {DepthConfig::Method::kThesis, DepthConfig::Method::kRays,
                                           DepthConfig::Method::kSweep};
  config.method = kMethods[state.range(0)];
  set_thread_count(static_cast<int>(state.range(1)));
  const Recording& r = recording();
  const auto windows = cut_windows(r.events, r.trajectory, {.duration_s = 0.1});
  const auto estimator = make_depth_estimator(config, r.world.camera(), 2.5);
  for (auto _ : state)
    parallel_for(windows.size(), [&](std::size_t i) {
      benchmark::DoNotOptimize(estimator->estimate(windows[i]).points.size());
    });
  items_per_second(state, r.events.size());
  set_thread_count(0);
}
BENCHMARK(depth)
    ->ArgsProduct({{0, 1, 2}, {1, 2}})
    ->ArgNames({"method", "threads"})
    ->UseRealTime()
    ->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace saccade
