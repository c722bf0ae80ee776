#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/trajectory.h"

namespace saccade {

namespace config {
class Fields;
}

/// A camera of a model file as the source of a motion.
struct ModelCameraOptions {
  std::filesystem::path file;
  std::string camera;              ///< its name; empty: the only one
  std::string animation;           ///< its name or index; empty: the first one, if there is one
  bool is_y_up = false;            ///< the file's axis that points upwards, which the world's z is
  double duration_s = 1;           ///< of a camera that does not move
  bool sets_focal_length = false;  ///< the recording's from the vertical field of view
};

void describe(config::Fields& fields, ModelCameraOptions& options);

/// Poses of the camera (x right, y down, z forward) in the model's axes, turned upright: from time 0
/// to the end of the animation, at least every 10 ms and four times between two keys; of one that
/// rests its pose for the duration. Throws InputError naming the known cameras, for a camera
/// without a view direction, and as find_animation() has it.
[[nodiscard]] std::vector<StampedPose> model_camera_poses(const ModelCameraOptions& options);

/// Focal length [px] that shows its vertical field of view in an image of this height. Throws
/// InputError where the file states none.
[[nodiscard]] double model_focal_length_px(const ModelCameraOptions& options, int height_px);

}  // namespace saccade
