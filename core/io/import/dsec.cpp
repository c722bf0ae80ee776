#include <Eigen/LU>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <filesystem>

#include "core/config/config.h"
#include "core/error.h"
#include "core/image.h"
#include "core/io/files/file_list.h"
#include "core/io/images/image_file.h"
#include "core/io/import/camera_files.h"
#include "core/io/import/layouts.h"
#include "core/io/tables/text_table.h"
#include "core/io/trajectory_file.h"

namespace saccade {
namespace {

namespace fs = std::filesystem;

using Rows3 = std::array<std::array<double, 3>, 3>;
using Rows4 = std::array<std::array<double, 4>, 4>;

/// What is read of cam_to_cam.yaml: camera 0 is the left event camera, 3 the right one.
struct DsecCalibration {
  std::array<double, 4> camera_matrix{};  ///< fx fy cx cy [px]
  std::array<double, 4> distortion{};     ///< k1 k2 p1 p2
  std::string distortion_model = "radtan";
  std::array<int, 2> resolution{};
  Rows3 rectified_from_camera{};
  Rows4 point_from_disparity{};  ///< Q: (u, v, disparity, 1) -> homogeneous point, rectified
};

void describe(config::Fields& fields, DsecCalibration& calibration) {
  fields.allow_unknown();
  const auto describe_camera = [&](config::Fields& camera) {
    camera.allow_unknown();
    camera.value("camera_matrix", calibration.camera_matrix, "fx fy cx cy").required();
    camera.value("distortion_coeffs", calibration.distortion, "k1 k2 p1 p2").required();
    camera.value("distortion_model", calibration.distortion_model, "lens").one_of({"radtan"});
    camera.value("resolution", calibration.resolution, "width height").required();
  };
  fields.group(
      "intrinsics",
      [&](config::Fields& all) {
        all.allow_unknown();
        all.group("cam0", describe_camera, "left event camera");
      },
      "cameras");
  fields.group(
      "extrinsics",
      [&](config::Fields& all) {
        all.allow_unknown();
        all.value("R_rect0", calibration.rectified_from_camera, "rotation").required();
      },
      "between cameras");
  fields.group(
      "disparity_to_depth",
      [&](config::Fields& all) {
        all.allow_unknown();
        all.value("cams_03", calibration.point_from_disparity, "Q").required();
      },
      "matrices Q");
}

template <int N, class Rows>
Eigen::Matrix<double, N, N> matrix_of(const Rows& rows) {
  Eigen::Matrix<double, N, N> matrix;
  for (int r = 0; r < N; ++r)
    for (int c = 0; c < N; ++c)
      matrix(r, c) = rows[static_cast<std::size_t>(r)][static_cast<std::size_t>(c)];
  return matrix;
}

PinholeCamera camera_of(const DsecCalibration& calibration) {
  const auto& [fx, fy, cx, cy] = calibration.camera_matrix;
  const auto& [k1, k2, p1, p2] = calibration.distortion;
  return {calibration.resolution[0], calibration.resolution[1], fx, fy, cx, cy,
          {k1, k2, p1, p2, 0}};
}

/// Pictures in the order of their names with the times of timestamps.txt [us], a line for each.
std::vector<StampedFile> disparities_in(const fs::path& folder) {
  std::vector<StampedFile> list;
  if (!fs::exists(folder / "event")) return list;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder / "event"))
    if (entry.path().extension() == ".png") list.push_back({0, entry.path()});
  std::sort(list.begin(), list.end(),
            [](const StampedFile& a, const StampedFile& b) { return a.file < b.file; });
  std::size_t count = 0;
  for_each_row(folder / "timestamps.txt", [&](TextRow& row) {
    const double t_s = 1e-6 * row.number("t");
    row.expect_end("t [us]");
    if (count < list.size()) list[count].t_s = t_s;
    if (count > 0 && count < list.size() && !(t_s > list[count - 1].t_s))
      row.fail("times must increase");
    ++count;
    return true;
  });
  if (count != list.size())
    throw InputError((folder / "timestamps.txt").string(),
                     "holds " + std::to_string(count) + " times for " +
                         std::to_string(list.size()) + " pictures in event/");
  return list;
}

/// Carries every disparity of the rectified view into the raw one; the nearest point of a pixel
/// counts. Codes are 256 times the disparity [px], 0 is unknown.
ImageF depth_from_disparity(const fs::path& file, const DsecCalibration& calibration) {
  const PinholeCamera camera = camera_of(calibration);
  const Eigen::Matrix4d q = matrix_of<4>(calibration.point_from_disparity);
  const Eigen::Matrix3d camera_from_rectified =
      matrix_of<3>(calibration.rectified_from_camera).transpose();
  const ImageU16 codes = read_image_u16(file);
  ImageF depth(camera.width, camera.height);
  for (int v = 0; v < codes.height(); ++v)
    for (int u = 0; u < codes.width(); ++u) {
      if (codes(u, v) == 0) continue;
      const Eigen::Vector4d h = q * Eigen::Vector4d(u, v, codes(u, v) / 256.0, 1);
      const Eigen::Vector3d point = camera_from_rectified * (h.head<3>() / h[3]);
      if (!(point.z() > 0)) continue;
      const Eigen::Vector2d pixel = camera.distort(camera.project(point));
      if (!camera.contains(pixel)) continue;
      float& z =
          depth(static_cast<int>(std::lround(pixel.x())), static_cast<int>(std::lround(pixel.y())));
      const auto found = static_cast<float>(point.z());
      if (z == 0 || found < z) z = found;
    }
  return depth;
}

}  // namespace

bool is_dsec(const fs::path& folder) {
  return fs::is_directory(folder) && fs::exists(folder / "events" / "left" / "events.h5");
}

PublicSequence open_dsec(const fs::path& folder, const fs::path& chosen) {
  const fs::path below = folder / "calibration" / "cam_to_cam.yaml";
  const fs::path calibration_file = fs::exists(below) ? below : folder / "cam_to_cam.yaml";
  if (!fs::exists(calibration_file))
    throw InputError(
        folder.string(),
        "holds no calibration/cam_to_cam.yaml, which DSEC publishes beside the events");
  const auto calibration = config::read<DsecCalibration>(config::load(calibration_file));
  PublicSequence sequence;
  sequence.layout = "DSEC";
  sequence.events = folder / "events" / "left" / "events.h5";
  sequence.camera.camera = camera_of(calibration);
  sequence.camera.camera.check(calibration_file.string());
  if (!chosen.empty())
    sequence.camera =
        read_any_calibration(chosen, {calibration.resolution[0], calibration.resolution[1]});
  const std::vector<StampedFile> disparities = disparities_in(folder / "disparity");
  for (const StampedFile& disparity : disparities) sequence.depth_times_s.push_back(disparity.t_s);
  sequence.load_depth = [calibration, disparities](std::size_t index) {
    return depth_from_disparity(disparities[index].file, calibration);
  };
  if (const fs::path poses = folder / "groundtruth.txt"; fs::exists(poses)) {
    const Trajectory truth = read_tum_trajectory(poses);
    sequence.groundtruth.assign(truth.poses().begin(), truth.poses().end());
  }
  return sequence;
}

}  // namespace saccade
