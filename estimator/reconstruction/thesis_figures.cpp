#include "estimator/reconstruction/thesis_figures.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/io/images/exr_file.h"
#include "core/io/run/view_list.h"
#include "estimator/reconstruction/gradient/poisson.h"
#include "estimator/reconstruction/surface/depth_source.h"

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

}  // namespace

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

}  // namespace saccade
