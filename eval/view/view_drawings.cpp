#include "eval/view/view_drawings.h"

#include <cmath>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "core/io/files/file_bytes.h"
#include "core/io/images/image_file.h"
#include "core/io/ply_file.h"
#include "eval/depth_views.h"
#include "eval/image_views.h"
#include "eval/picture/canvas/colour.h"
#include "eval/picture/image/depth_picture.h"
#include "eval/picture/view/view_pictures.h"

namespace saccade {
namespace {

constexpr int kDepthUpscale = 2;           ///< sparse depths are squares of some pixels
constexpr std::size_t kMostDepthMaps = 8;  ///< of which the cloud of a recording is made
constexpr std::size_t kPointsOfDepthMap = 5'000;

ViewPicture png(const ImageRgb8& image) { return {"image/png", encode_png(image)}; }

std::string packed(std::span<const Eigen::Vector3f> points) {
  const std::size_t stride = 1 + points.size() / (kMostCloudPoints + 1);
  std::string bytes;
  for (std::size_t i = 0; i < points.size(); i += stride)
    if (points[i].allFinite())
      bytes.append(reinterpret_cast<const char*>(points[i].data()), 3 * sizeof(float));
  return bytes;
}

void append_points(const ImageF& depth, const PinholeCamera& camera,
                   const Rigid3& world_from_camera, std::vector<Eigen::Vector3f>& points) {
  const auto step =
      static_cast<int>(std::ceil(std::sqrt(static_cast<double>(depth.size()) / kPointsOfDepthMap)));
  for (int y = step / 2; y < depth.height(); y += step)
    for (int x = step / 2; x < depth.width(); x += step) {
      if (depth(x, y) <= 0) continue;
      const Eigen::Vector3d ray = camera.ray(camera.undistort({x, y}));
      points.emplace_back((world_from_camera * (depth(x, y) * ray)).cast<float>());
    }
}

}  // namespace

ViewPicture stored_picture(const std::filesystem::path& file) {
  const std::vector<std::byte> bytes = read_file_bytes(file);
  return {"image/png", {reinterpret_cast<const char*>(bytes.data()), bytes.size()}};
}

ViewPicture frame_picture(const ViewRecording& recording, std::size_t index) {
  const std::filesystem::path& file = recording.dataset.frames().at(index).file;
  if (file.extension() != ".png") return png(draw_radiance(recording.dataset.load_frame(index)));
  return stored_picture(file);
}

ViewPicture depth_picture(const ViewRecording& recording, std::size_t index) {
  const ImageF depth = recording.dataset.load_depth(index);
  return png(draw_depth(depth, recording.depth_range.value_or(depth_range(depth)), kDarkTheme));
}

ViewPicture run_depth_picture(const ViewRun& run, const ViewRecording& recording,
                              std::size_t index) {
  const RunView& view = run.views.at(index);
  EstimatedView found = load_depth_map(view.depth, recording.dataset, view.t_s);
  for (DepthPoint& point : found.points) point.depth_m *= run.truth_from_estimate.scale;
  const std::optional<DepthRange>& common = recording.depth_range;
  return png(draw_depth_points(found.points, recording.dataset.camera().undistorted(),
                               common ? *common : depth_range(found.points), kDepthUpscale,
                               kDarkTheme));
}

ViewPicture run_image_picture(const ViewRun& run, std::size_t index) {
  const RunView& view = run.views.at(index);
  return png(draw_image_alone(read_log_image(view.image, view.t_s), 1));
}

std::string run_cloud(const ViewRun& run) {
  const std::filesystem::path cloud = run.run.folder / "cloud.ply";
  return packed(run.truth_from_estimate * (std::filesystem::exists(cloud)
                                               ? read_ply(cloud).positions
                                               : run.run.load_map().positions));
}

std::string recording_cloud(const ViewRecording& recording) {
  const Dataset& dataset = recording.dataset;
  std::vector<Eigen::Vector3f> points;
  for (const std::size_t i : evenly_spaced_indices(dataset.depth_maps().size(), kMostDepthMaps)) {
    const std::optional<Rigid3> pose = dataset.groundtruth().empty()
                                           ? std::nullopt
                                           : dataset.groundtruth().at(dataset.depth_maps()[i].t_s);
    if (pose) append_points(dataset.load_depth(i), dataset.camera(), *pose, points);
  }
  return packed(points);
}

}  // namespace saccade
