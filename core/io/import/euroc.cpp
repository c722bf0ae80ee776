#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <memory>

#include "core/config/config.h"
#include "core/error.h"
#include "core/io/files/file_list.h"
#include "core/io/images/image_file.h"
#include "core/io/import/camera_files.h"
#include "core/io/import/h5_arrays.h"
#include "core/io/import/layouts.h"
#include "core/io/tables/text_table.h"
#include "core/io/trajectory_file.h"

namespace saccade {
namespace {

namespace fs = std::filesystem;

/// What is read of cam0/sensor.yaml.
struct AslCamera {
  std::vector<double> body_from_camera;  ///< T_BS, 16 numbers row by row
  std::array<int, 2> resolution{};
  std::array<double, 4> intrinsics{};
  std::string model = "pinhole";
  std::string lens = "radial-tangential";
  std::vector<double> coefficients;
};

void describe(config::Fields& fields, AslCamera& camera) {
  fields.allow_unknown();
  fields.group(
      "T_BS",
      [&](config::Fields& keys) {
        keys.allow_unknown();
        keys.value("data", camera.body_from_camera, "16 numbers, row by row").required();
      },
      "from the camera to the body");
  fields.value("resolution", camera.resolution, "width height").required();
  fields.value("camera_model", camera.model, "model").one_of({"pinhole"});
  fields.value("intrinsics", camera.intrinsics, "fu fv cu cv").required();
  fields.value("distortion_model", camera.lens, "lens").one_of({"radial-tangential"});
  fields.value("distortion_coefficients", camera.coefficients, "k1 k2 p1 p2").required();
  fields.expect(camera.body_from_camera.size() == 16, "T_BS", "must hold 16 numbers");
  fields.expect(camera.coefficients.size() == 4 || camera.coefficients.size() == 5,
                "distortion_coefficients", "must hold k1 k2 p1 p2 and perhaps k3");
}

fs::path asl_root(const fs::path& folder) {
  return fs::is_directory(folder / "mav0") ? folder / "mav0" : folder;
}

/// Lines `t [ns],file` of pictures in data/.
std::vector<StampedFile> asl_frames(const fs::path& camera) {
  std::vector<StampedFile> frames;
  for_each_row(camera / "data.csv", [&](TextRow& row) {
    const double t_s = seconds_from_ns(row.integer("timestamp"));
    const fs::path file = camera / "data" / std::string(row.word("filename"));
    row.expect_end("timestamp,filename");
    if (!frames.empty() && !(t_s > frames.back().t_s)) row.fail("times must increase");
    frames.push_back({t_s, file});
    return true;
  });
  return frames;
}

/// Lines `t [ns],wx,wy,wz,ax,ay,az`.
std::vector<ImuSample> asl_imu(const fs::path& file) {
  std::vector<ImuSample> samples;
  for_each_row(file, [&](TextRow& row) {
    ImuSample sample;
    sample.t_ns = row.integer("timestamp");
    for (int i = 0; i < 3; ++i) sample.angular_velocity[i] = row.number("gyroscope");
    for (int i = 0; i < 3; ++i) sample.specific_force[i] = row.number("accelerometer");
    row.expect_end("timestamp,wx,wy,wz,ax,ay,az");
    if (!samples.empty() && sample.t_ns <= samples.back().t_ns) row.fail("times must increase");
    samples.push_back(sample);
    return true;
  });
  return samples;
}

}  // namespace

bool is_euroc(const fs::path& folder) {
  const fs::path camera = asl_root(folder) / "cam0";
  return fs::exists(camera / "sensor.yaml") && fs::exists(camera / "data.csv");
}

PublicSequence open_euroc(const fs::path& folder, const fs::path& calibration) {
  const fs::path root = asl_root(folder);
  const fs::path sensor = root / "cam0" / "sensor.yaml";
  const auto asl = config::read<AslCamera>(config::load(sensor));
  const Rigid3 body_from_camera = rigid_of(asl.body_from_camera.data(), sensor.string() + ":T_BS");
  PublicSequence sequence;
  sequence.layout = "EuRoC";
  PinholeCamera& camera = sequence.camera.camera;
  const auto& [fx, fy, cx, cy] = asl.intrinsics;
  camera = {asl.resolution[0], asl.resolution[1], fx, fy, cx, cy, {}};
  std::copy(asl.coefficients.begin(), asl.coefficients.end(), camera.distortion.begin());
  camera.check(sensor.string());
  if (!calibration.empty())
    sequence.camera = read_any_calibration(calibration, {asl.resolution[0], asl.resolution[1]});
  // The body is the inertial sensor.
  sequence.camera.camera_from_imu = body_from_camera.inverse();
  const std::vector<StampedFile> frames = asl_frames(root / "cam0");
  for (const StampedFile& frame : frames) sequence.frame_times_s.push_back(frame.t_s);
  sequence.load_frame = [frames](std::size_t index) { return read_image_grey(frames[index].file); };
  if (const fs::path imu = root / "imu0" / "data.csv"; fs::exists(imu)) sequence.imu = asl_imu(imu);
  const fs::path truth = root / "state_groundtruth_estimate0" / "data.csv";
  if (!fs::exists(truth)) return sequence;
  const Trajectory body = read_csv_trajectory(truth);
  for (const StampedPose& pose : body.poses())
    sequence.groundtruth.push_back({pose.t_s, pose.world_from_camera * body_from_camera});
  return sequence;
}

}  // namespace saccade
