#include "simulator/replica/replica.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <span>
#include <string>
#include <vector>

#include "core/check.h"
#include "core/io/calibration_file.h"
#include "core/io/files/atomic_file.h"
#include "core/io/images/exr_file.h"
#include "core/io/trajectory_file.h"

namespace saccade {
namespace fs = std::filesystem;
namespace {

/// Beyond the frame on each side [px]: views that rotate out of it see its mirror image, not a step.
constexpr int kBorderPx = 48;
/// Texels of a pixel: between them the scene is bilinear, which between pixels would be too smooth.
constexpr int kTexels = 3;

cv::Mat view_of(const ImageF& image) {
  return {image.height(), image.width(), CV_32F,
          const_cast<float*>(image.data())};  // OpenCV has no view of constants
}

/// The frame without its noise: means over neighbours that differ by no more than noise does.
ImageF without_noise(const ImageF& radiance, double noise) {
  if (noise <= 0) return radiance;
  constexpr int kDiameterPx = 5;
  constexpr double kReach_px = 1.5, kSigmas = 3;
  ImageF smooth(radiance.width(), radiance.height());
  cv::Mat out = view_of(smooth);
  cv::bilateralFilter(view_of(radiance), out, kDiameterPx, kSigmas * noise, kReach_px);
  return smooth;
}

/// Undistorted pixel of the frame that a texel shows.
Eigen::Vector2d pixel_of_texel(int i, int j) {
  return {(i + 0.5) / kTexels - kBorderPx - 0.5, (j + 0.5) / kTexels - kBorderPx - 0.5};
}

/// The frame as the plane shows it: cubic between the pixels, mirrored beyond the borders.
ImageF texture_of(const ReplicaSource& source) {
  const PinholeCamera& camera = source.camera;
  const int width = kTexels * (camera.width + 2 * kBorderPx);
  const int height = kTexels * (camera.height + 2 * kBorderPx);
  ImageF map_x(width, height), map_y(width, height), texture(width, height);
  for (int j = 0; j < height; ++j)
    for (int i = 0; i < width; ++i) {
      const Eigen::Vector2d pixel = camera.distort(pixel_of_texel(i, j));
      map_x(i, j) = static_cast<float>(pixel.x());
      map_y(i, j) = static_cast<float>(pixel.y());
    }
  const ImageF frame = without_noise(source.radiance, source.noise);
  cv::Mat out = view_of(texture);
  cv::remap(view_of(frame), out, view_of(map_x), view_of(map_y), cv::INTER_CUBIC,
            cv::BORDER_REFLECT_101);
  for (float& value : texture.pixels()) value = std::max(value, 0.0F);
  return texture;
}

/// The plane in the world, with the corners of its texture.
std::string plane_text(const ReplicaSource& source) {
  const PinholeCamera& camera = source.camera;
  const double left = -kBorderPx - 0.5, right = camera.width + kBorderPx - 0.5;
  const double top = -kBorderPx - 0.5, bottom = camera.height + kBorderPx - 0.5;
  std::string text = "mtllib scene.mtl\nusemtl frame\n";
  const std::array<Eigen::Vector4d, 4> corners{
      {{left, top, 0, 1}, {right, top, 1, 1}, {right, bottom, 1, 0}, {left, bottom, 0, 0}}};
  for (const Eigen::Vector4d& corner : corners) {
    const Eigen::Vector3d point =
        source.world_from_frame *
        Eigen::Vector3d(source.depth_m * camera.ray({corner.x(), corner.y()}));
    text += fmt::format("v {} {} {}\nvt {} {}\n", point.x(), point.y(), point.z(), corner.z(),
                        corner.w());
  }
  return text + "f 1/1 2/2 3/3 4/4\n";
}

/// A pose before the first, at the constant velocity of the first two.
StampedPose pose_before(std::span<const StampedPose> poses, double t_s) {
  const StampedPose &first = poses[0], &second = poses[1];
  const double fraction = (t_s - first.t_s) / (second.t_s - first.t_s);
  const Rigid3 first_from_second = first.world_from_camera.inverse() * second.world_from_camera;
  return {t_s, first.world_from_camera * Rigid3::exp(fraction * first_from_second.log())};
}

/// The poses from the warm-up's begin to the part's end and some beyond where there are any, for the
/// spline's sake.
std::vector<StampedPose> poses_of_part(const ReplicaSource& source) {
  constexpr std::size_t kBeyond = 4;
  const auto poses = source.motion.poses();
  const double begin_s = source.start_s - source.warm_up_s;
  const double end_s = source.start_s + source.duration_s;
  const std::size_t before = source.motion.last_before(begin_s).value_or(0);
  const std::size_t last = source.motion.last_before(end_s).value_or(0);
  const std::size_t begin = before > kBeyond ? before - kBeyond : 0;
  const std::size_t end = std::min(last + 1 + kBeyond, poses.size());
  std::vector<StampedPose> part;
  if (poses.front().t_s > begin_s) part.push_back(pose_before(poses, begin_s));
  part.insert(part.end(), poses.begin() + static_cast<std::ptrdiff_t>(begin),
              poses.begin() + static_cast<std::ptrdiff_t>(end));
  return part;
}

std::string simulation_text(const ReplicaSource& source, double first_pose_s) {
  const PinholeCamera& c = source.camera;
  return fmt::format(
      "scene: {{meshes: [{{file: scene.obj}}]}}\n"
      "trajectory: {{source: file, file: groundtruth.txt, fit: {}}}\n"
      "start_s: {}\n"
      "duration_s: {}\n"
      "camera:\n"
      "  {{width: {}, height: {}, fx: {}, fy: {}, cx: {}, cy: {}, distortion: [{}, {}, {}, {}, "
      "{}]}}\n"
      "events: {{log_eps: {}}}\n",
      source.smooths_motion ? "smooth, knot_spacing_s: 0.04" : "interpolate",
      std::max(0.0, source.start_s - source.warm_up_s - first_pose_s),
      source.warm_up_s + source.duration_s, c.width, c.height, c.fx, c.fy, c.cx, c.cy,
      c.distortion[0], c.distortion[1], c.distortion[2], c.distortion[3], c.distortion[4],
      source.log_eps);
}

/// Whether the camera at `world_from_camera` sees, along `ray`, a place within the frame.
bool sees_frame(const ReplicaSource& source, const Rigid3& frame_from_camera,
                const Eigen::Vector3d& ray, double margin_px) {
  const Eigen::Vector3d direction = frame_from_camera.rotation() * ray;
  const Eigen::Vector3d origin = frame_from_camera.translation();
  const double along = (source.depth_m - origin.z()) / direction.z();
  if (!(along > 0)) return false;
  const Eigen::Vector3d point = origin + along * direction;
  const PinholeCamera& camera = source.camera;
  const Eigen::Vector2d pixel = camera.distort(camera.project(point));
  return pixel.x() >= margin_px && pixel.y() >= margin_px &&
         pixel.x() <= camera.width - 1 - margin_px && pixel.y() <= camera.height - 1 - margin_px;
}

}  // namespace

void write_replica(const ReplicaSource& source, const fs::path& folder) {
  SACCADE_CHECK(source.radiance.width() == source.camera.width &&
                source.radiance.height() == source.camera.height);
  SACCADE_CHECK(source.depth_m > 0 && source.duration_s > 0 && source.warm_up_s >= 0);
  SACCADE_CHECK(source.motion.size() >= 2);
  fs::create_directories(folder);
  write_exr(folder / "frame.exr", texture_of(source), "Y");
  write_atomically(folder / "scene.mtl", "newmtl frame\nmap_Kd frame.exr\n");
  write_atomically(folder / "scene.obj", plane_text(source));
  const std::vector<StampedPose> poses = poses_of_part(source);
  write_tum_trajectory(folder / "groundtruth.txt", poses);
  write_calib_txt(folder / "calib.txt", source.camera);
  write_atomically(folder / "simulation.yaml", simulation_text(source, poses.front().t_s));
}

ImageU8 comparable_pixels(const ReplicaSource& source, double margin_px) {
  constexpr int kTimes = 12;
  const PinholeCamera& camera = source.camera;
  const Rigid3 frame_from_world = source.world_from_frame.inverse();
  const UndistortionTable undistorted(camera);
  ImageU8 seen(camera.width, camera.height, 1);
  for (int k = 0; k <= kTimes; ++k) {
    const double t_s = source.start_s + source.duration_s * k / kTimes;
    const Rigid3 frame_from_camera = frame_from_world * source.motion.at_clamped(t_s);
    for (int y = 0; y < camera.height; ++y)
      for (int x = 0; x < camera.width; ++x) {
        if (seen(x, y) == 0) continue;
        const Eigen::Vector3d ray = camera.ray(undistorted(x, y).cast<double>());
        if (!sees_frame(source, frame_from_camera, ray, margin_px)) seen(x, y) = 0;
      }
  }
  return seen;
}

double frame_noise(const ImageF& radiance) {
  constexpr int kBlockPx = 5;
  std::vector<double> sigmas;
  for (int top = 0; top + kBlockPx <= radiance.height(); top += kBlockPx)
    for (int left = 0; left + kBlockPx <= radiance.width(); left += kBlockPx) {
      double sum = 0, squares = 0;
      for (int y = top; y < top + kBlockPx; ++y)
        for (int x = left; x < left + kBlockPx; ++x) {
          sum += radiance(x, y);
          squares += static_cast<double>(radiance(x, y)) * radiance(x, y);
        }
      constexpr double kCount = kBlockPx * kBlockPx;
      sigmas.push_back(std::sqrt(std::max(0.0, (squares - sum * sum / kCount) / (kCount - 1))));
    }
  if (sigmas.empty()) return 0;
  const auto low = sigmas.begin() + static_cast<std::ptrdiff_t>(sigmas.size() / 20);
  std::nth_element(sigmas.begin(), low, sigmas.end());
  return *low;
}

}  // namespace saccade
