#include <fmt/format.h>

#include <cctype>
#include <cmath>

#include "core/config/config.h"
#include "core/error.h"
#include "core/fisheye_camera.h"
#include "core/io/import/camera_files.h"
#include "core/io/import/layouts.h"
#include "core/io/tables/text_table.h"

namespace saccade {
namespace {

namespace fs = std::filesystem;

/// basalt's calibrations are JSON, and that is YAML.
struct BasaltPose {
  double px = 0, py = 0, pz = 0, qx = 0, qy = 0, qz = 0, qw = 1;

  [[nodiscard]] Rigid3 rigid() const {
    return {Eigen::Quaterniond(qw, qx, qy, qz).normalized(), Eigen::Vector3d(px, py, pz)};
  }
};

void describe(config::Fields& fields, BasaltPose& pose) {
  fields.value("px", pose.px, "[m]").required();
  fields.value("py", pose.py, "[m]").required();
  fields.value("pz", pose.pz, "[m]").required();
  fields.value("qx", pose.qx, "quaternion").required();
  fields.value("qy", pose.qy, "quaternion").required();
  fields.value("qz", pose.qz, "quaternion").required();
  fields.value("qw", pose.qw, "quaternion").required();
}

struct BasaltCamera {
  std::string type = "kb4";
  FisheyeCamera camera;
};

void describe(config::Fields& fields, BasaltCamera& basalt) {
  fields.value("camera_type", basalt.type, "model").one_of({"kb4"});
  fields.group(
      "intrinsics",
      [&](config::Fields& keys) {
        keys.value("fx", basalt.camera.fx, "[px]").required();
        keys.value("fy", basalt.camera.fy, "[px]").required();
        keys.value("cx", basalt.camera.cx, "[px]").required();
        keys.value("cy", basalt.camera.cy, "[px]").required();
        for (const std::size_t i : {0U, 1U, 2U, 3U})
          keys.value("k" + std::to_string(i + 1), basalt.camera.k[i], "lens").required();
      },
      "of the model");
}

/// Cameras are left, right, left events, right events.
constexpr std::size_t kLeftEvents = 2;

struct TumVieCameras {
  std::vector<BasaltPose> imu_from_camera;
  std::vector<BasaltCamera> cameras;
  std::vector<std::array<int, 2>> resolution;
};

void describe(config::Fields& fields, TumVieCameras& calibration) {
  fields.group(
      "value0",
      [&](config::Fields& keys) {
        keys.allow_unknown();
        keys.list("T_imu_cam", calibration.imu_from_camera, "poses").required();
        keys.list("intrinsics", calibration.cameras, "models").required();
        keys.value("resolution", calibration.resolution, "[px]").required();
        const std::size_t least = kLeftEvents + 1;
        keys.expect(calibration.imu_from_camera.size() >= least &&
                        calibration.cameras.size() >= least &&
                        calibration.resolution.size() >= least,
                    "T_imu_cam", "must hold the left event camera as the third camera");
      },
      "calibration");
}

struct TumVieMarker {
  BasaltPose imu_from_marker;
};

void describe(config::Fields& fields, TumVieMarker& calibration) {
  fields.group(
      "value0",
      [&](config::Fields& keys) {
        keys.allow_unknown();
        keys.section("T_imu_marker", calibration.imu_from_marker, "pose").required();
      },
      "calibration");
}

/// The one file in `folder`, or in a folder below it, whose name begins and ends so; empty: none.
fs::path find_one(const fs::path& folder, const std::string& begin, const std::string& end) {
  fs::path found;
  for (const fs::directory_entry& entry : fs::recursive_directory_iterator(folder)) {
    const std::string name = entry.path().filename().string();
    if (!name.starts_with(begin) || !name.ends_with(end)) continue;
    if (!found.empty())
      throw InputError(folder.string(),
                       fmt::format("holds both {} and {}; keep the one that belongs to the "
                                   "sequence",
                                   found.filename().string(), name));
    found = entry.path();
  }
  return found;
}

bool is_header_line(std::string_view line) {
  return std::isalpha(static_cast<unsigned char>(line.front())) != 0;
}

/// Calls `take` for every row below the line of column names.
template <class Take>
void for_each_sample(const fs::path& file, Take take) {
  TextReader reader(file);
  std::string_view line;
  for (bool first = true; reader.next(line); first = false) {
    if (first && is_header_line(line)) continue;
    TextRow row = reader.row(line);
    take(row);
  }
}

/// Lines `t [us] gx gy gz [rad/s] ax ay az [m/s^2] temperature`.
std::vector<ImuSample> read_tum_vie_imu(const fs::path& file) {
  std::vector<ImuSample> samples;
  for_each_sample(file, [&](TextRow& row) {
    ImuSample sample;
    sample.t_ns = ns_from_seconds(1e-6 * row.number("t"));
    for (int i = 0; i < 3; ++i) sample.angular_velocity[i] = row.number("gyroscope");
    for (int i = 0; i < 3; ++i) sample.specific_force[i] = row.number("accelerometer");
    if (!row.at_end()) static_cast<void>(row.number("temperature"));
    row.expect_end("t gx gy gz ax ay az temperature");
    if (!samples.empty() && sample.t_ns <= samples.back().t_ns) row.fail("times must increase");
    samples.push_back(sample);
  });
  return samples;
}

/// Lines `t [us] x y z qx qy qz qw` of the marker, as world_from_camera.
std::vector<StampedPose> read_mocap(const fs::path& file, const Rigid3& marker_from_camera) {
  std::vector<StampedPose> poses;
  for_each_sample(file, [&](TextRow& row) {
    const double t_s = 1e-6 * row.number("t");
    Eigen::Vector3d t;
    Eigen::Vector4d q;
    for (int i = 0; i < 3; ++i) t[i] = row.number("position");
    for (int i = 0; i < 4; ++i) q[i] = row.number("quaternion");
    row.expect_end("t x y z qx qy qz qw");
    if (!(std::abs(q.norm() - 1) <= 1e-3)) row.fail("the quaternion is no rotation");
    if (!poses.empty() && !(t_s > poses.back().t_s)) row.fail("times must increase");
    poses.push_back({t_s, Rigid3(Eigen::Quaterniond(q).normalized(), t) * marker_from_camera});
  });
  return poses;
}

}  // namespace

bool is_tum_vie(const fs::path& folder) {
  if (!fs::is_directory(folder)) return false;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder))
    if (entry.path().filename().string().ends_with("events_left.h5")) return true;
  return false;
}

PublicSequence open_tum_vie(const fs::path& folder, const fs::path& chosen) {
  const fs::path calibration_file = find_one(folder, "camera-calibration", ".json");
  if (calibration_file.empty())
    throw InputError(folder.string(),
                     "holds no camera-calibration*.json, which TUM-VIE publishes beside the "
                     "sequences");
  auto calibration = config::read<TumVieCameras>(config::load(calibration_file));
  FisheyeCamera& lens = calibration.cameras[kLeftEvents].camera;
  lens.width = calibration.resolution[kLeftEvents][0];
  lens.height = calibration.resolution[kLeftEvents][1];
  const FisheyeFit fit = fit_pinhole(lens, calibration_file.string());
  if (fit.residual_px > kMostFitResidual_px)
    throw InputError(calibration_file.string(),
                     fmt::format("no radial-tangential model is nearer to this lens than {:.2g} px",
                                 fit.residual_px));
  const Rigid3 imu_from_camera = calibration.imu_from_camera[kLeftEvents].rigid();
  PublicSequence sequence;
  sequence.layout = "TUM-VIE";
  sequence.events = find_one(folder, "", "events_left.h5");
  sequence.camera.camera = fit.camera;
  sequence.camera.camera.check(calibration_file.string());
  sequence.camera.camera_from_imu = imu_from_camera.inverse();
  sequence.camera.residual_px = fit.residual_px;
  if (!chosen.empty()) {
    sequence.camera = read_any_calibration(chosen, {lens.width, lens.height});
    sequence.camera.camera_from_imu = imu_from_camera.inverse();
  }
  if (const fs::path imu = find_one(folder, "imu_data", ".txt"); !imu.empty())
    sequence.imu = read_tum_vie_imu(imu);
  const fs::path mocap = find_one(folder, "mocap_data", ".txt");
  if (mocap.empty()) return sequence;
  const fs::path marker_file = find_one(folder, "mocap-imu-calibration", ".json");
  if (marker_file.empty())
    throw InputError(folder.string(),
                     "holds mocap_data.txt, poses of a marker, but no mocap-imu-calibration*.json, "
                     "which says where the camera is");
  const auto marker = config::read<TumVieMarker>(config::load(marker_file));
  sequence.groundtruth =
      read_mocap(mocap, marker.imu_from_marker.rigid().inverse() * imu_from_camera);
  return sequence;
}

}  // namespace saccade
