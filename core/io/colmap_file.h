#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "core/rigid3.h"
#include "core/trajectory.h"

namespace saccade {

/// The pose of one picture, as COLMAP found it: in a world of its own, without a scale.
struct NamedPose {
  std::string name;  ///< of the picture, with the folders that COLMAP knew
  Rigid3 world_from_camera;
  std::string location;  ///< "file:line"
};

/// images.txt of COLMAP's text export: two lines for each picture, `IMAGE_ID QW QX QY QZ TX TY TZ
/// CAMERA_ID NAME` (camera from world) and its points, which may be none. InputError with `file:line`.
[[nodiscard]] std::vector<NamedPose> read_colmap_images(const std::filesystem::path& file);
/// Whether the first line with content is the first of such a pair.
[[nodiscard]] bool is_colmap_images(const std::filesystem::path& file);

/// In order of the times of the pictures, by their file names without folders. InputError where a
/// picture has no time, or two have the same.
[[nodiscard]] Trajectory trajectory_of(const std::vector<NamedPose>& poses,
                                       const std::map<std::string, double>& times_s);

}  // namespace saccade
