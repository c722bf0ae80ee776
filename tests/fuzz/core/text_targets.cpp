// Configurations, tables, calibrations and records: what people and other programs write as text.

#include "tests/fuzz/core/core_targets.h"

#include <fmt/format.h>

#include <array>
#include <stdexcept>
#include <utility>

#include "core/config/config.h"
#include "core/error.h"
#include "core/imu_sample.h"
#include "core/io/calibration_file.h"
#include "core/io/colmap_file.h"
#include "core/io/covariance_file.h"
#include "core/io/dataset/dataset_record.h"
#include "core/io/files/file_list.h"
#include "core/io/import/camera_files.h"
#include "core/io/imu_file.h"
#include "core/io/labels/box_file.h"
#include "core/io/labels/label_record.h"
#include "core/io/labels/optical_flow_file.h"
#include "core/io/run/keyframe_list.h"
#include "core/io/run/run_record.h"
#include "core/io/run/view_list.h"
#include "core/io/sensor_file.h"
#include "core/io/tables/csv_reader.h"
#include "core/io/trajectory_file.h"

namespace saccade::fuzz {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kYaml =
    "include: part.yaml\n# a comment\nscene: &scene\n  meshes:\n    - {file: 'a b.obj', scale: "
    "1.5e0}\n"
    "    - *scene2\nlist: [1, -2.5, .inf, ~, \"x\\ty\"]\ntext: |\n  lines\n  of text\n";

void write_yaml(const fs::path& folder) {
  std::string text(kYaml);
  text.replace(text.find("*scene2"), 7, "{}");
  write_bytes(folder / "fuzz.yaml", text);
  write_bytes(folder / "part.yaml", "list: [3]\nscene: {background: 0.5}\n");
}

/// What was read is printed, and the print read again: the same.
void decode_yaml(const fs::path& folder, const std::string& /*file*/) {
  const std::string once = config::to_yaml(config::load(folder / "fuzz.yaml").root());
  const std::string twice = config::to_yaml(config::parse(once, "print").root());
  if (once != twice) throw std::logic_error("what is printed reads as something else");
}

void write_overrides(const fs::path& folder) {
  write_bytes(
      folder / "overrides.txt",
      "scene.meshes.0.file=a.obj\nlist=[1, 2]\nscene.background=~\nlist.1=7\na.b.c={d: 1}\n");
}

void decode_overrides(const fs::path& folder, const std::string& /*file*/) {
  std::vector<std::string> overrides;
  std::string line;
  for (const char c : read_bytes(folder / "overrides.txt"))
    if (c == '\n')
      overrides.push_back(std::exchange(line, ""));
    else
      line += c;
  if (overrides.empty()) throw InputError("overrides.txt", "is empty");
  static_cast<void>(config::parse("scene: {meshes: [{file: x}], background: 1}\nlist: [4, 5]\n",
                                  "base.yaml", folder, overrides));
}

std::vector<StampedPose> some_poses() {
  return {{0.25, Rigid3()}, {0.5, Rigid3(so3_exp({0.1, -0.2, 0.3}), {1, 2, 3})}};
}

const std::array<const char*, 13> kTables = {
    "tum.txt",    "asl.csv",   "orientation.txt", "twist.txt",  "objects.txt",
    "rates.txt",  "imu.txt",   "imu_truth.txt",   "biases.txt", "covariance.txt",
    "images.txt", "boxes.txt", "colmap.txt"};

void write_tables(const fs::path& folder) {
  const std::vector<StampedPose> poses = some_poses();
  write_tum_trajectory(folder / "tum.txt", poses);
  write_bytes(folder / "asl.csv",
              "#timestamp, p_RS_R_x [m], p_RS_R_y [m], p_RS_R_z [m], q_RS_w [], q_RS_x [], q_RS_y "
              "[], q_RS_z []\n1000,1,2,3,1,0,0,0\n2000,1,2,4,0,1,0,0\n");
  write_orientations(folder / "orientation.txt", poses);
  const std::vector<StampedTwist> twists(1);
  write_twists(folder / "twist.txt", twists);
  write_angular_velocities(folder / "rates.txt", twists);
  write_object_poses(folder / "objects.txt", std::vector<ObjectPose>(1));
  write_imu(folder / "imu.txt", std::vector<ImuSample>(1));
  write_imu_truth(folder / "imu_truth.txt", std::vector<ImuTruth>(1));
  write_gyro_biases(folder / "biases.txt", std::vector<GyroBiasEstimate>(1));
  write_covariances(folder / "covariance.txt", std::vector<StampedCovariance>(1));
  write_bytes(folder / "images.txt", "0.000000000 images/a.png\n0.5 images/b.png\n");
  write_boxes(folder / "boxes.txt", {});
  write_bytes(folder / "colmap.txt", "# COLMAP\n1 1 0 0 0 1 2 3 1 a.png\n5.0 6.0 -1\n");
}

void decode_tables(const fs::path& folder, const std::string& file) {
  const fs::path path = folder / file;
  if (file == "tum.txt") static_cast<void>(read_trajectory(path));
  if (file == "asl.csv") static_cast<void>(read_csv_trajectory(path));
  if (file == "orientation.txt") static_cast<void>(read_orientations(path));
  if (file == "twist.txt") static_cast<void>(read_twists(path));
  if (file == "rates.txt") static_cast<void>(read_angular_velocities(path));
  if (file == "objects.txt") static_cast<void>(read_object_poses(path));
  if (file == "imu.txt") static_cast<void>(read_imu(path));
  if (file == "imu_truth.txt") static_cast<void>(read_imu_truth(path));
  if (file == "biases.txt") static_cast<void>(read_gyro_biases(path));
  if (file == "covariance.txt") static_cast<void>(read_covariances(path));
  if (file == "images.txt") static_cast<void>(read_file_list(path));
  if (file == "boxes.txt") static_cast<void>(read_boxes(path));
  if (file == "colmap.txt") static_cast<void>(read_colmap_images(path));
}

void write_calibrations(const fs::path& folder) {
  const PinholeCamera camera{240, 180, 200, 201, 119.5, 89.5, {-0.3, 0.1, 1e-3, 0, 0.01}};
  write_calib_txt(folder / "calib.txt", camera);
  std::vector<ChainCamera> chain(2);
  for (ChainCamera& link : chain) link.camera = camera;
  chain[1].camera_from_previous = Rigid3(so3_exp({0, 0.1, 0}), {0.1, 0, 0});
  chain[0].camera_from_imu = Rigid3();
  write_camera_chain(folder / "camera.yaml", chain);
  ImuCalibration imu;
  imu.rate_hz = 200;
  write_imu_yaml(folder / "imu.yaml", imu);
  SensorFile sensor;
  sensor.name = "a sensor";
  sensor.events.contrast_on = 0.2;
  sensor.intervals["contrast_on"] = {0.1, 0.3};
  write_sensor_file(folder / "sensor.yaml", sensor);
  write_bytes(
      folder / "ros.yaml",
      "image_width: 240\nimage_height: 180\ncamera_matrix: {rows: 3, cols: 3, data: [200, 0, "
      "119.5, 0, 201, 89.5, 0, 0, 1]}\ndistortion_model: plumb_bob\ndistortion_coefficients: "
      "{rows: 1, cols: 5, data: [-0.3, 0.1, 0, 0, 0]}\n");
}

void decode_calibrations(const fs::path& folder, const std::string& file) {
  const fs::path path = folder / file;
  if (file == "calib.txt") static_cast<void>(read_calib_txt(path));
  if (file == "calib.txt") static_cast<void>(read_any_calibration(path, {240, 180}));
  if (file == "camera.yaml") static_cast<void>(read_camera_chain(path));
  if (file == "camera.yaml") static_cast<void>(read_any_calibration(path, {}));
  if (file == "imu.yaml") static_cast<void>(read_imu_yaml(path));
  if (file == "sensor.yaml") static_cast<void>(read_sensor_file(path));
  if (file == "ros.yaml") static_cast<void>(read_any_calibration(path, {}));
}

void write_records(const fs::path& folder) {
  RunRecord run;
  run.module = "track";
  run.dataset = folder / "d";
  run.config_yaml = "method: edges\n";
  run.window = RunRecord::Window{0, 1};
  write_run_record(folder / "run.yaml", run);
  DatasetRecord dataset;
  dataset.width = 240;
  dataset.height = 180;
  dataset.counts = DatasetRecord::Counts{};
  dataset.sha256["events.h5"] = std::string(64, '0');
  write_dataset_record(folder / "dataset.yaml", dataset);
  RunView view;
  view.end_s = 1;
  view.depth = folder / "depth.exr";
  write_view_list(folder / "views.yaml", std::vector{view});
  KeyframeEntry keyframe;
  keyframe.active = {0};
  write_keyframe_list(folder / "keyframes.yaml", std::vector{keyframe});
  LabelRecord labels;
  labels.classes = {{1, "chair"}};
  labels.instances = {{1, "a chair", 1, 0, "chair.obj"}};
  write_label_record(folder / "labels.yaml", labels);
}

void decode_records(const fs::path& folder, const std::string& file) {
  const fs::path path = folder / file;
  if (file == "run.yaml") static_cast<void>(read_run_record(path));
  if (file == "dataset.yaml") static_cast<void>(read_dataset_record(path));
  if (file == "views.yaml") static_cast<void>(read_view_list(path));
  if (file == "keyframes.yaml") static_cast<void>(read_keyframe_list(path));
  if (file == "labels.yaml") static_cast<void>(read_label_record(path));
}

}  // namespace

std::vector<Target> text_targets() {
  return {
      {"yaml",
       {"fuzz.yaml", "part.yaml"},
       decode_yaml,
       write_yaml,
       {"include: ", "&a ", "*a", "- ", ": ", "|\n", ">-\n", "!!str ", "<<: ", "---\n", "...\n",
        "~", "? ", "\xef\xbb\xbf", "fuzz.yaml", "%YAML 1.2\n"}},
      {"overrides",
       {"overrides.txt"},
       decode_overrides,
       write_overrides,
       {"scene.", ".0", ".-1", "=~\n", "={}\n", "=[]\n", "list.", "..", "=*a\n"}},
      {"tables",
       {kTables.begin(), kTables.end()},
       decode_tables,
       write_tables,
       {"nan", "inf", "1e308", "-0", "1e-320", "# ", "9223372036854775807", "\r\n", ","}},
      {"calibrations",
       {"calib.txt", "camera.yaml", "imu.yaml", "sensor.yaml", "ros.yaml"},
       decode_calibrations,
       write_calibrations,
       {"equidistant", "radtan", "none", "omni", "T_cam_imu", "T_cn_cnm1", "resolution: [240, 180]",
        "timeshift_cam_imu", "distortion_coeffs", "1e308", "cam1:", ".nan"}},
      {"records",
       {"run.yaml", "dataset.yaml", "views.yaml", "keyframes.yaml", "labels.yaml"},
       decode_records,
       write_records,
       {"format_version: 1", "external:", "method_class:", "audit:", "window:", "1e308", "-1",
        "~"}},
  };
}

}  // namespace saccade::fuzz
