#include "estimator/reconstruction/reconstruction_module.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <span>
#include <vector>

#include "core/config/config.h"
#include "core/io/dataset/dataset.h"
#include "core/io/images/exr_file.h"
#include "core/io/run/view_list.h"
#include "estimator/reconstruction/contrast_thresholds.h"
#include "estimator/reconstruction/gradient/poisson.h"
#include "estimator/reconstruction/image_solver.h"
#include "estimator/reconstruction/reconstruction_config.h"
#include "estimator/reconstruction/reconstruction_output.h"
#include "estimator/reconstruction/surface/depth_source.h"
#include "estimator/run/run_input.h"
#include "estimator/run/run_writer.h"
#include "estimator/run/view_run.h"

namespace saccade {
namespace {

constexpr int kKernels[] = {1, 3, 7, 15, 25};  ///< the thesis's, and the points alone
constexpr double kPropagationS = 0.2;  ///< longer, much of the view lies outside the depth map

std::vector<ExrChannel> poisson_stages(ImageF log_image) {
  subtract_mean(log_image);
  GradientField gradient = forward_gradient(log_image);
  ImageF laplacian = divergence(gradient);
  ImageF dirichlet = solve_poisson(laplacian, Boundary::kDirichlet);
  ImageF neumann = solve_poisson(laplacian, Boundary::kNeumann);
  subtract_mean(dirichlet);
  return {{"L", std::move(log_image)},         {"gx", std::move(gradient.x)},
          {"gy", std::move(gradient.y)},       {"div", std::move(laplacian)},
          {"dirichlet", std::move(dirichlet)}, {"neumann", std::move(neumann)}};
}

ImageF log_frame_nearest(const Dataset& dataset, double t_s) {
  const auto nearest = std::min_element(dataset.frames().begin(), dataset.frames().end(),
                                        [t_s](const StampedFile& a, const StampedFile& b) {
                                          return std::abs(a.t_s - t_s) < std::abs(b.t_s - t_s);
                                        });
  ImageF image = dataset.load_frame(static_cast<std::size_t>(nearest - dataset.frames().begin()));
  const auto eps = static_cast<float>(dataset.facts().log_eps);
  for (float& value : image.pixels()) value = std::log(eps + value);
  return image;
}

/// Depth map [m] of a scene, 0 = unknown.
ImageF depth_of(const DepthScene& scene, const Rigid3& world_from_camera,
                const PinholeCamera& camera) {
  ImageF depth(camera.width, camera.height);
  scene.draw(world_from_camera.inverse(), camera, depth);
  for (float& value : depth.pixels()) value = value > 0 ? 1 / value : 0;
  return depth;
}

std::vector<ExrChannel> propagated(const ImageF& depth, const PinholeCamera& camera,
                                   const Rigid3& world_from_depth,
                                   const Rigid3& world_from_target) {
  DepthSourceOptions options;
  const auto rendered = [&] {
    return depth_of(scene_of(depth, camera, world_from_depth, options), world_from_target, camera);
  };
  std::vector<ExrChannel> channels = {{"Z", rendered()}};
  options.propagation = DepthSourceOptions::Propagation::kSplat;
  for (const int size : kKernels) {
    options.kernel_px = size;
    channels.push_back({fmt::format("k{:02}", size), rendered()});
  }
  return channels;
}

/// Writes the thesis's figures of two parts of the method, computed from the truth, into
/// `folder`/figures:
///   poisson.exr (fig. 6.1), if the dataset has frames: log intensity `L` of the grey frame nearest to
///     the view, of mean 0; its gradient `gx`, `gy` and divergence `div`; the solutions of Poisson's
///     equation for that, of mean 0: `dirichlet`, `neumann`.
///   propagation.exr (fig. 6.2): the depth of the view [m], 0 = unknown, propagated to a view 0.2 s
///     away within the window: `Z` as a surface, `k01`, `k03` ... as Gaussians of 1 x 1, 3 x 3 ...
///     pixels; time and pose in views.yaml.
void write_thesis_figures(const std::filesystem::path& folder, const Dataset& dataset,
                          const ReconstructionWindow& window) {
  const std::filesystem::path figures = folder / "figures";
  std::filesystem::create_directories(figures);
  if (!dataset.frames().empty())
    write_exr(figures / "poisson.exr",
              poisson_stages(log_frame_nearest(dataset, window.reference_s)));
  RunView view;
  view.start_s = seconds_from_ns(window.events.front().t_ns);
  view.end_s = seconds_from_ns(window.events.back().t_ns);
  const bool is_later = view.end_s - window.reference_s > window.reference_s - view.start_s;
  view.t_s = is_later ? std::min(view.end_s, window.reference_s + kPropagationS)
                      : std::max(view.start_s, window.reference_s - kPropagationS);
  view.world_from_camera = window.trajectory->at_clamped(view.t_s);
  view.depth = figures / "propagation.exr";
  const PinholeCamera camera = dataset.camera().undistorted();
  const ImageF depth = depth_of(window.scene, window.world_from_reference(), camera);
  write_exr(view.depth,
            propagated(depth, camera, window.world_from_reference(), view.world_from_camera));
  write_view_list(figures / "views.yaml", std::vector{view});
}

std::vector<ReconstructionWindow> make_windows(const ViewInput& input, const Dataset& dataset,
                                               const DepthSource& depth,
                                               const ReconstructionConfig& config) {
  const ContrastThresholds thresholds =
      contrast_thresholds(config.contrast_on, config.contrast_off, dataset);
  std::vector<ReconstructionWindow> windows;
  for (const ViewWindow& part :
       cut_windows(input.events(), input.trajectory, config.window, dataset.frames()))
    windows.push_back({part, depth.scene_at(part.reference_s), thresholds});
  return windows;
}

}  // namespace

RunSummary run_reconstruction(const RunRequest& request) {
  const auto config = read_config<ReconstructionConfig>(request);
  RunWriter writer(request);

  RunTiming timing;
  const Dataset dataset = Dataset::open(request.dataset);
  const ViewInput input = load_view_input(request, dataset, timing);
  std::vector<ReconstructionWindow> windows;
  {
    const ScopedTimer clock(timing.io_s);
    const DepthSource depth(dataset, request.depth_from, input.trajectory, config.depth);
    windows = make_windows(input, dataset, depth, config);
  }
  const auto estimator = make_image_estimator(config, dataset.camera());
  const auto results = estimate_views<Reconstruction>(
      "reconstruction", windows, request.repeat, timing,
      [&](const ReconstructionWindow& window) { return estimator->reconstruct(window); });
  const auto snapshots = take_snapshots(windows.front().events, config.snapshot_events,
                                        [&](std::span<const Event> events) {
                                          ReconstructionWindow part = windows.front();
                                          part.events = events;
                                          return estimator->reconstruct(part).log_image;
                                        });
  {
    const ScopedTimer clock(timing.io_s);
    write_reconstruction(writer.path(), windows, results, snapshots);
    if (config.figures) write_thesis_figures(writer.path(), dataset, windows.front());
  }
  writer.finish("reconstruct", request, dataset, input.window, config.seed, config::print(config),
                timing);

  return summary_of(timing, fmt::format("{} views", windows.size()));
}

}  // namespace saccade
