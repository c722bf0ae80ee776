#include "core/io/export/pose_export.h"

#include <fmt/format.h>

#include <string>

#include "core/error.h"
#include "core/io/files/atomic_file.h"
#include "core/io/trajectory_file.h"

namespace saccade {
namespace {

namespace fs = std::filesystem;

/// A text as JSON has it.
std::string quoted(const std::string& text) {
  std::string json = "\"";
  for (const char c : text) {
    const auto code = static_cast<unsigned char>(c);
    if (c == '"' || c == '\\')
      json += std::string("\\") + c;
    else if (code < 0x20)
      json += fmt::format("\\u{:04x}", code);
    else
      json += c;
  }
  return json + "\"";
}

std::string json_matrix(const Rigid3& world_from_camera) {
  // Of the camera's axes y and z change their signs.
  Eigen::Matrix4d matrix = Eigen::Matrix4d::Identity();
  matrix.topLeftCorner<3, 3>() = world_from_camera.rotation_matrix();
  matrix.topRightCorner<3, 1>() = world_from_camera.translation();
  matrix.block<4, 2>(0, 1) *= -1;
  std::string rows;
  for (int r = 0; r < 4; ++r)
    rows += fmt::format("{}[{}, {}, {}, {}]", r == 0 ? "" : ", ", matrix(r, 0), matrix(r, 1),
                        matrix(r, 2), matrix(r, 3));
  return "[" + rows + "]";
}

std::string json_camera(const PinholeCamera& camera) {
  constexpr double kCorner = 0.5;
  const auto& [k1, k2, p1, p2, k3] = camera.distortion;
  return fmt::format(
      "  \"camera_model\": \"OPENCV\",\n  \"fl_x\": {}, \"fl_y\": {}, \"cx\": {}, \"cy\": {},\n"
      "  \"w\": {}, \"h\": {}, \"k1\": {}, \"k2\": {}, \"p1\": {}, \"p2\": {}, \"k3\": {},\n",
      camera.fx, camera.fy, camera.cx + kCorner, camera.cy + kCorner, camera.width, camera.height,
      k1, k2, p1, p2, k3);
}

}  // namespace

std::size_t write_nerfstudio(const Dataset& dataset, const Trajectory& trajectory,
                             const fs::path& file) {
  const fs::path folder = fs::absolute(file).lexically_normal().parent_path();
  std::string frames;
  std::size_t count = 0;
  for (const StampedFile& frame : dataset.frames()) {
    const auto pose = trajectory.empty() ? std::nullopt : trajectory.at(frame.t_s);
    if (!pose) continue;
    const fs::path picture = fs::absolute(frame.file).lexically_normal();
    const fs::path relative = picture.lexically_relative(folder);
    const bool is_below = !relative.empty() && *relative.begin() != "..";
    frames += fmt::format("{}    {{\"file_path\": {}, \"time\": {}, \"transform_matrix\": {}}}",
                          count == 0 ? "" : ",\n", quoted((is_below ? relative : picture).string()),
                          frame.t_s, json_matrix(*pose));
    ++count;
  }
  if (count == 0)
    throw InputError(dataset.folder().string(), "has no frame at a time that has a pose");
  write_atomically(
      file, "{\n" + json_camera(dataset.camera()) + "  \"frames\": [\n" + frames + "\n  ]\n}\n");
  return count;
}

void write_trajectory_evaluation(const Trajectory& truth, const Trajectory& estimate,
                                 const fs::path& folder) {
  if (truth.empty()) throw InputError(folder.string(), "the dataset has no ground truth to write");
  if (estimate.empty()) throw InputError(folder.string(), "the run has no poses to write");
  AtomicFolder output(folder, "stamped_traj_estimate.txt");
  write_tum_trajectory(output.path() / "stamped_groundtruth.txt", truth.poses());
  write_tum_trajectory(output.path() / "stamped_traj_estimate.txt", estimate.poses());
  output.commit();
}

}  // namespace saccade
