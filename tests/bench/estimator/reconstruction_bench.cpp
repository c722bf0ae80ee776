#include <benchmark/benchmark.h>

#include <utility>
#include <vector>

#include "core/depth_mesh.h"
#include "core/process/parallel.h"
#include "estimator/reconstruction/level_system.h"
#include "estimator/reconstruction/place_finder.h"
#include "estimator/reconstruction/place_levels.h"
#include "estimator/reconstruction/poisson.h"
#include "estimator/reconstruction/reconstruction_config.h"
#include "estimator/reconstruction/reference_grid.h"
#include "estimator/run/view_windows.h"
#include "tests/support/planar_world.h"

namespace saccade {
namespace {

using testing::corner_motion;
using testing::corner_world;
using testing::PlanarWorld;

constexpr double kContrast = 0.15;
constexpr double kReference_s = 0.2;

Trajectory corner_trajectory() {
  std::vector<StampedPose> poses;
  for (int i = 0; i <= 400; ++i) poses.push_back({i * 1e-3, corner_motion(i * 1e-3)});
  return Trajectory(poses);
}

/// A corner of textured walls at the DAVIS's 240 x 180, its events of 0.4 s and its true depth.
struct Recording {
  PlanarWorld world = corner_world(240, 180);
  Trajectory trajectory = corner_trajectory();
  Events events = world.simulate(corner_motion, 0, 0.4, 1e-3, kContrast);
  Rigid3 world_from_reference = corner_motion(kReference_s);
  DepthMesh mesh{world.depth(world_from_reference), world.camera()};
  DepthScene scene;
  ImageF inverse_depth{240, 180};  ///< of the reference view

  Recording() {
    scene.typical_depth_m = mesh.typical_depth_m();
    scene.draw = [this](const Rigid3& camera_from_world, const PinholeCamera& target,
                        ImageF& inverse) {
      mesh.draw(camera_from_world * world_from_reference, target, inverse);
    };
    scene.draw(world_from_reference.inverse(), world.camera(), inverse_depth);
  }
  Recording(const Recording&) = delete;
  Recording& operator=(const Recording&) = delete;
};

const Recording& recording() {
  static const Recording recording;
  return recording;
}

/// The thresholds of configs/reconstruction/best.yaml.
EquationOptions best() {
  EquationOptions options;
  options.levels = {.event_sigma = 0.075,
                    .track_events = 12,
                    .still_px = 0.7,
                    .still_turns = 4,
                    .still_events = 40,
                    .beyond = 0.4,
                    .places = {.redraw_px = 8, .parallax_px = 1.4, .step_margin_px = 1}};
  options.thin_px = 0.9;
  options.smoothness = 0.05;
  options.bound_sigma = 0.3;
  options.tolerance = 0.005;
  return options;
}

void items_per_second(benchmark::State& state, std::size_t count) {
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(count));
}

std::vector<PlaceLevel> levels_of_recording() {
  const Recording& r = recording();
  SurfaceLevels finder(r.world.camera(), r.scene, r.world_from_reference, r.inverse_depth,
                       kContrast, kContrast, best().levels);
  finder.expect(r.events);
  std::vector<PlaceLevel> levels;
  finder.find(r.events, r.trajectory, levels);
  return levels;
}

/// Places of all pixels at one pose, on surfaces that are drawn already.
void places(benchmark::State& state) {
  const Recording& r = recording();
  PlaceFinder finder(r.world.camera(), r.scene, r.world_from_reference, r.inverse_depth,
                     best().levels.places);
  const Rigid3 motion = r.world_from_reference.inverse() * corner_motion(0.25);
  const CameraPose pose{motion.rotation_matrix().cast<float>(), motion.translation().cast<float>()};
  finder.prepare(pose);
  for (auto _ : state)
    for (int y = 0; y < 180; ++y)
      for (int x = 0; x < 240; ++x) benchmark::DoNotOptimize(finder.find(x, y, pose));
  items_per_second(state, r.inverse_depth.size());
}
BENCHMARK(places)->Unit(benchmark::kMicrosecond);

/// Surfaces of one view, drawn with the depth test.
void surfaces(benchmark::State& state) {
  const Recording& r = recording();
  ImageF inverse(240, 180);
  for (auto _ : state) {
    r.scene.draw(corner_motion(0.25).inverse(), r.world.camera(), inverse);
    benchmark::DoNotOptimize(inverse.data());
  }
  items_per_second(state, inverse.size());
}
BENCHMARK(surfaces)->Unit(benchmark::kMicrosecond);

/// What all events and silent pixels say; items are events.
void levels(benchmark::State& state) {
  static_cast<void>(recording());  // made before the clock runs
  for (auto _ : state) benchmark::DoNotOptimize(levels_of_recording().size());
  items_per_second(state, recording().events.size());
}
BENCHMARK(levels)->Unit(benchmark::kMillisecond);

std::vector<std::vector<GridLevel>> tracks_of(const std::vector<PlaceLevel>& levels,
                                              const ReferenceGrid& grid) {
  std::vector<std::vector<GridLevel>> tracks;
  for (const PlaceLevel& level : levels) {
    if (level.track() >= tracks.size()) tracks.resize(level.track() + 1);
    tracks[level.track()].push_back({grid.at(level.x, level.y), level.level, 100});
  }
  return tracks;
}

void assemble(const std::vector<std::vector<GridLevel>>& tracks, const ReferenceGrid& grid,
              LevelSystem& system) {
  system.clear();
  for (const auto& track : tracks)
    if (track.size() > 1) system.add_track(track);
  for (int i = 0; i + 1 < grid.width() * grid.height(); ++i)
    if ((i + 1) % grid.width() != 0) system.add_smooth(i, i + 1, 1);
}

/// Equations of all levels; items are levels.
void assembly(benchmark::State& state) {
  const std::vector<PlaceLevel> found = levels_of_recording();
  const ReferenceGrid grid(recording().inverse_depth, 1, 0.05);
  const auto tracks = tracks_of(found, grid);
  LevelSystem system(grid.width(), grid.height());
  for (auto _ : state) assemble(tracks, grid, system);
  items_per_second(state, found.size());
}
BENCHMARK(assembly)->Unit(benchmark::kMillisecond);

/// Ten steps of conjugate gradients; items are steps.
void solution(benchmark::State& state) {
  constexpr int kSteps = 10;
  const ReferenceGrid grid(recording().inverse_depth, 1, 0.05);
  LevelSystem system(grid.width(), grid.height());
  assemble(tracks_of(levels_of_recording(), grid), grid, system);
  for (auto _ : state) benchmark::DoNotOptimize(system.solve(kSteps, 0).residual);
  items_per_second(state, kSteps);
}
BENCHMARK(solution)->Unit(benchmark::kMillisecond);

/// Poisson's equation of a 240 x 180 view. Argument: boundary.
void poisson(benchmark::State& state) {
  const Recording& r = recording();
  const ImageF laplacian =
      divergence(forward_gradient(r.world.log_intensity(r.world_from_reference)));
  for (auto _ : state)
    benchmark::DoNotOptimize(
        solve_poisson(laplacian, static_cast<Boundary>(state.range(0))).data());
  items_per_second(state, laplacian.size());
}
BENCHMARK(poisson)
    ->Arg(static_cast<int>(Boundary::kDirichlet))
    ->Arg(static_cast<int>(Boundary::kNeumann))
    ->ArgName("boundary")
    ->Unit(benchmark::kMicrosecond);

/// The whole recording in four windows. Arguments: method, threads.
void reconstruction(benchmark::State& state) {
  const Recording& r = recording();
  ReconstructionConfig config;
  config.method = static_cast<ReconstructionConfig::Method>(state.range(0));
  config.equations = best();
  set_thread_count(static_cast<int>(state.range(1)));
  std::vector<ReconstructionWindow> windows;
  for (const ViewWindow& cut : cut_windows(r.events, r.trajectory, {.duration_s = 0.1}))
    windows.push_back({cut, r.scene, kContrast, kContrast});
  const auto estimator = make_image_estimator(config, r.world.camera());
  for (auto _ : state)
    parallel_for(windows.size(), [&](std::size_t i) {
      benchmark::DoNotOptimize(estimator->reconstruct(windows[i]).levels);
    });
  items_per_second(state, r.events.size());
  set_thread_count(0);
}
BENCHMARK(reconstruction)
    ->ArgsProduct({{0, 1}, {1, 2}})
    ->ArgNames({"method", "threads"})
    ->UseRealTime()
    ->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace saccade
