#include "estimator/reconstruction/surface/depth_source.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "core/depth_mesh.h"
#include "core/error.h"
#include "core/io/images/exr_file.h"
#include "estimator/reconstruction/surface/depth_splat.h"
#include "estimator/reconstruction/surface/point_surface.h"

namespace saccade {
namespace {

std::size_t nearest_in_time(const std::vector<StampedFile>& files, double t_s) {
  std::size_t best = 0;
  for (std::size_t i = 1; i < files.size(); ++i)
    if (std::abs(files[i].t_s - t_s) < std::abs(files[best].t_s - t_s)) best = i;
  return best;
}

std::vector<RunView> views_with_depth(const std::filesystem::path& folder) {
  std::vector<RunView> views = read_view_list(folder / "views.yaml");
  std::erase_if(views, [](const RunView& view) { return view.depth.empty(); });
  if (views.empty()) throw InputError((folder / "views.yaml").string(), "lists no view with depth");
  return views;
}

/// The depth map of a view of a depth run, as points in the world with the sigma of their depth.
void append_points(const RunView& view, const PinholeCamera& camera,
                   std::vector<SurfacePoint>& points) {
  const ImageF depth = read_exr(view.depth);
  ImageF variance;
  for (ExrChannel& channel : read_exr_channels(view.depth))
    if (channel.name == "variance") variance = std::move(channel.image);
  if (depth.width() != camera.width || depth.height() != camera.height)
    throw InputError(view.depth.string(), "has another size than the sensor");
  for (int y = 0; y < depth.height(); ++y)
    for (int x = 0; x < depth.width(); ++x) {
      const auto z = static_cast<double>(depth(x, y));
      if (!(z > 0) || !std::isfinite(z)) continue;
      const double sigma =
          variance.empty() ? 0.01 * z : std::sqrt(static_cast<double>(variance(x, y)));
      points.push_back({view.world_from_camera * (z * camera.ray({x, y})), sigma / z});
    }
}

}  // namespace

void describe(config::Fields& fields, DepthSourceOptions& options) {
  using Propagation = DepthSourceOptions::Propagation;
  fields.choice("propagation", options.propagation,
                {{"surface", Propagation::kSurface}, {"splat", Propagation::kSplat}},
                "Rendering of the known depth into other views: surface draws triangles between "
                "neighbouring pixels; splat draws every point as a Gaussian, as the thesis does "
                "(6.21), and enlarges all contours by half the kernel.");
}

DepthScene scene_of(const ImageF& depth, const PinholeCamera& camera,
                    const Rigid3& world_from_depth, const DepthSourceOptions& options) {
  const auto mesh = std::make_shared<DepthMesh>(depth, camera);
  DepthScene scene;
  scene.typical_depth_m = mesh->typical_depth_m();
  if (options.propagation == DepthSourceOptions::Propagation::kSurface) {
    scene.draw = [mesh, world_from_depth](const Rigid3& camera_from_world,
                                          const PinholeCamera& target, ImageF& inverse_depth) {
      mesh->draw(camera_from_world * world_from_depth, target, inverse_depth);
    };
    return scene;
  }
  const auto splat = std::make_shared<DepthSplat>(points_of(depth, camera), options.kernel_px);
  scene.draw = [splat, world_from_depth](const Rigid3& camera_from_world,
                                         const PinholeCamera& target, ImageF& inverse_depth) {
    splat->draw(camera_from_world * world_from_depth, target, inverse_depth);
  };
  return scene;
}

DepthSource::DepthSource(const Dataset& dataset,
                         const std::optional<std::filesystem::path>& depth_from,
                         const Trajectory& trajectory, const DepthSourceOptions& options)
    : dataset_(dataset), trajectory_(trajectory), options_(options) {
  if (depth_from) {
    views_ = views_with_depth(*depth_from);
    return;
  }
  if (dataset.depth_maps().empty())
    throw InputError(dataset.folder().string(),
                     "holds no depth maps; name a run of depth: --depth-from RUN");
}

DepthScene DepthSource::scene_at(double reference_s) const {
  if (!views_.empty()) {
    const Rigid3 world_from_reference = trajectory_.at_clamped(reference_s);
    return scene_of(dense_depth(world_from_reference), dataset_.camera().undistorted(),
                    world_from_reference, options_);
  }
  const std::size_t nearest = nearest_in_time(dataset_.depth_maps(), reference_s);
  return scene_of(dataset_.load_depth(nearest), dataset_.camera(),
                  trajectory_.at_clamped(dataset_.depth_maps()[nearest].t_s), options_);
}

ImageF DepthSource::dense_depth(const Rigid3& world_from_reference) const {
  const PinholeCamera camera = dataset_.camera().undistorted();
  std::vector<SurfacePoint> points;
  for (const RunView& view : views_) append_points(view, camera, points);
  const Rigid3 reference_from_world = world_from_reference.inverse();
  for (SurfacePoint& point : points) point.position = reference_from_world * point.position;
  return surface_through(points, camera);
}

}  // namespace saccade
