#include <benchmark/benchmark.h>

#include <vector>

#include "core/depth_mesh.h"
#include "core/process/parallel.h"
#include "estimator/reconstruction/equations/intensity_system.h"
#include "estimator/reconstruction/gradient/poisson.h"
#include "estimator/reconstruction/observations/intensity_observations.h"
#include "estimator/reconstruction/observations/reference_grid.h"
#include "estimator/reconstruction/observations/reprojector.h"
#include "estimator/reconstruction/reconstruction_config.h"
#include "estimator/run/view_windows.h"
#include "tests/support/intensity_observations.h"
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

void items_per_second(benchmark::State& state, std::size_t count) {
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(count));
}

std::vector<IntensityObservation> observations_of_recording() {
  const Recording& r = recording();
  SurfaceObservations source(r.world.camera(), r.scene, r.world_from_reference, r.inverse_depth,
                             {kContrast, kContrast}, EquationOptions{}.observations);
  return testing::observations_of(source, r.events, r.trajectory, 1);
}

/// Reprojections of all pixels at one pose, on surfaces that are rendered already.
void reprojections(benchmark::State& state) {
  const Recording& r = recording();
  Reprojector reprojector(r.world.camera(), r.scene, r.world_from_reference, r.inverse_depth,
                          EquationOptions{}.observations.reprojection);
  const Rigid3 motion = r.world_from_reference.inverse() * corner_motion(0.25);
  const CameraPose pose{motion.rotation_matrix().cast<float>(), motion.translation().cast<float>()};
  const auto surfaces = reprojector.prepare(pose);
  for (auto _ : state)
    for (int y = 0; y < 180; ++y)
      for (int x = 0; x < 240; ++x)
        benchmark::DoNotOptimize(reprojector.find(x, y, *surfaces, pose));
  items_per_second(state, r.inverse_depth.size());
}
BENCHMARK(reprojections)->Unit(benchmark::kMicrosecond);

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

/// Observations of all events and no-event constraints; items are events.
void observations(benchmark::State& state) {
  static_cast<void>(recording());  // made before the clock runs
  for (auto _ : state) benchmark::DoNotOptimize(observations_of_recording().size());
  items_per_second(state, recording().events.size());
}
BENCHMARK(observations)->Unit(benchmark::kMillisecond);

std::vector<std::vector<GridObservation>> runs_of(
    const std::vector<IntensityObservation>& observations, const ReferenceGrid& grid) {
  std::vector<std::vector<GridObservation>> runs;
  for (const IntensityObservation& observation : observations) {
    if (observation.run() >= runs.size()) runs.resize(observation.run() + 1);
    runs[observation.run()].push_back({observation.x, observation.y,
                                       grid.at(observation.x, observation.y),
                                       observation.log_intensity, 100});
  }
  return runs;
}

void assemble(const std::vector<std::vector<GridObservation>>& runs, const ReferenceGrid& grid,
              IntensitySystem& system) {
  system.clear();
  for (const auto& run : runs)
    if (run.size() > 1) system.add_run(0, run);
  for (int i = 0; i + 1 < grid.width() * grid.height(); ++i)
    if ((i + 1) % grid.width() != 0) system.add_smoothness_term(i, i + 1, 1);
}

/// Equations of all observations; items are observations.
void assembly(benchmark::State& state) {
  const std::vector<IntensityObservation> found = observations_of_recording();
  const ReferenceGrid grid(recording().inverse_depth);
  const auto runs = runs_of(found, grid);
  IntensitySystem system(grid.width(), grid.height());
  for (auto _ : state) assemble(runs, grid, system);
  items_per_second(state, found.size());
}
BENCHMARK(assembly)->Unit(benchmark::kMillisecond);

/// Ten iterations of conjugate gradients; items are iterations.
void solution(benchmark::State& state) {
  constexpr int kSteps = 10;
  const ReferenceGrid grid(recording().inverse_depth);
  IntensitySystem system(grid.width(), grid.height());
  assemble(runs_of(observations_of_recording(), grid), grid, system);
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
  config.method = state.range(0) == 0 ? config.kGradient : config.kEquations;
  set_thread_count(static_cast<int>(state.range(1)));
  std::vector<ReconstructionWindow> windows;
  for (const ViewWindow& cut : cut_windows(r.events, r.trajectory, {.duration_s = 0.1}))
    windows.push_back({cut, r.scene, {kContrast, kContrast}});
  const auto estimator = make_image_estimator(config, r.world.camera());
  for (auto _ : state)
    parallel_for(windows.size(), [&](std::size_t i) {
      benchmark::DoNotOptimize(estimator->reconstruct(windows[i]).observations);
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
