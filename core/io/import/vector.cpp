#include <fmt/format.h>

#include "core/config/config.h"
#include "core/config/rigid3_node.h"
#include "core/error.h"
#include "core/io/import/camera_files.h"
#include "core/io/import/folder_search.h"
#include "core/io/import/h5_arrays.h"
#include "core/io/import/layouts.h"
#include "core/io/trajectory_file.h"

namespace saccade {
namespace {

namespace fs = std::filesystem;

/// The calibration of VECtor that is named so; InputError where there is none.
fs::path vector_file(const fs::path& folder, const std::string& begin, const std::string& end) {
  const fs::path found = find_near(folder, begin, end);
  if (found.empty())
    throw InputError(folder.string(),
                     fmt::format("holds no {}*{}, which VECtor publishes with its calibrations; "
                                 "it is looked for there, beside it, and in folders of both",
                                 begin, end));
  return found;
}

/// cameras.KEY of a file of extrinsics: 16 numbers, or 4 rows of 4.
Rigid3 vector_transform(const fs::path& file, const char* camera, const char* key) {
  const config::Document document = config::load(file);
  const config::Entry* entry = document.root().find(camera);
  const config::Entry* matrix = entry == nullptr ? nullptr : entry->value.find(key);
  if (matrix == nullptr)
    throw InputError(file.string(), fmt::format("the key {}.{} is missing", camera, key));
  const config::Node& node = matrix->value;
  std::vector<double> numbers;
  if (!node.items.empty() && node.items.front().items.empty()) {
    config::from_node(node, key, numbers);
  } else {
    for (const config::Node& row : node.items) {
      std::vector<double> part;
      config::from_node(row, key, part);
      numbers.insert(numbers.end(), part.begin(), part.end());
    }
  }
  if (numbers.size() != 16)
    throw InputError(node.location.text(), fmt::format("{} must hold 16 numbers", key));
  return rigid_of(numbers.data(), node.location.text());
}

}  // namespace

bool is_vector(const fs::path& folder) {
  return !files_in(folder, "", ".synced.left_event.hdf5").empty();
}

PublicSequence open_vector(const fs::path& folder, const fs::path& calibration) {
  PublicSequence sequence;
  sequence.layout = "VECtor";
  sequence.events = file_or_in_folder(folder, ".synced.left_event.hdf5");
  sequence.camera = read_any_calibration(
      calibration.empty() ? vector_file(folder, "left_event_camera_intrinsic_results", ".yaml")
                          : calibration,
      {});
  const fs::path poses = file_or_in_folder(folder, ".synced.gt.txt");
  if (poses.empty()) return sequence;
  // Camera 0 is the left regular camera, camera 2 the left event camera.
  const Rigid3 regular_from_events = vector_transform(
      vector_file(folder, "", "joint_camera_extrinsic_results.yaml"), "cam2", "T_cam0_cam2");
  const Rigid3 regular_from_body = vector_transform(
      vector_file(folder, "camera_mocap_extrinsic_results", ".yaml"), "cam0", "T_cam_body");
  const Trajectory truth = read_tum_trajectory(poses);
  for (const StampedPose& pose : truth.poses())
    sequence.groundtruth.push_back(
        {pose.t_s, pose.world_from_camera * regular_from_body.inverse() * regular_from_events});
  return sequence;
}

}  // namespace saccade
