#include "simulator/motion/model_camera.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/config/fields.h"
#include "core/config/suggest.h"
#include "core/error.h"
#include "simulator/scene/animation/model_motion.h"
#include "simulator/scene/animation/node_animation.h"

namespace saccade {
namespace {

constexpr double kLongestStep_s = 0.01;
/// Of an animation, as of every motion.
constexpr double kLongest_s = 3600;
/// More poses than an hour has milliseconds are no motion that somebody has animated.
constexpr double kMostPoses = 3.6e6;
/// Samples from one key to the next: a spline through them rounds the kinks of linear keys within
/// about a quarter of that.
constexpr double kSamplesPerKey = 4;
/// Keys nearer to each other are a jump, which no spline follows [s].
constexpr double kShortestKey_s = 0.004;

const ModelCamera& find_camera(const Model& model, const ModelCameraOptions& options) {
  const std::string source_name = options.file.string();
  if (model.cameras.empty())
    throw InputError(
        source_name,
        "holds no camera; exporters leave it out unless they are told (Blender: Include, "
        "Cameras)");
  std::vector<std::string> names;
  for (const ModelCamera& camera : model.cameras) {
    if (camera.name == options.camera) return camera;
    names.push_back(camera.name);
  }
  if (options.camera.empty()) {
    if (model.cameras.size() == 1) return model.cameras.front();
    throw InputError(source_name, fmt::format("holds {} cameras; state one: {}", names.size(),
                                              config::joined(names)));
  }
  throw InputError(source_name, fmt::format("holds no camera '{}'; its cameras: {}", options.camera,
                                            config::joined(names)));
}

Eigen::Matrix3d upright(bool is_y_up) {
  Eigen::Matrix3d turn = Eigen::Matrix3d::Identity();
  if (is_y_up) turn << 1, 0, 0, 0, 0, -1, 0, 1, 0;
  return turn;
}

Rigid3 pose_of(const ModelCamera& camera, const Eigen::Affine3d& world_from_node,
               const std::string& source_name) {
  const Eigen::Vector3d forward = world_from_node.linear() * Eigen::Vector3d(camera.forward.data());
  const Eigen::Vector3d up = world_from_node.linear() * Eigen::Vector3d(camera.up.data());
  const Eigen::Vector3d right = forward.cross(up);
  if (!(right.norm() > 1e-9 * forward.norm() * up.norm()))
    throw InputError(source_name, fmt::format("its camera '{}' has no view direction: its node is "
                                              "flat or looks along its upward axis",
                                              camera.name));
  Eigen::Matrix3d axes;
  axes.col(0) = right.normalized();
  axes.col(2) = forward.normalized();
  axes.col(1) = axes.col(2).cross(axes.col(0));
  return {Eigen::Quaterniond(axes), world_from_node * Eigen::Vector3d(camera.position.data())};
}

/// nullptr where the camera rests.
const ModelAnimation* animation_of(const Model& model, const ModelCameraOptions& options,
                                   std::int32_t node) {
  if (options.animation.empty() && model.animations.empty()) return nullptr;
  const ModelAnimation& animation =
      find_animation(model.animations, options.animation, options.file.string());
  const bool moves =
      node >= 0 &&
      NodeAnimation(model.tree, &animation).moved_nodes()[static_cast<std::size_t>(node)];
  if (!moves && !options.animation.empty())
    throw InputError(options.file.string(),
                     fmt::format("its animation '{}' does not move the camera", animation.name));
  return moves ? &animation : nullptr;
}

double step_s(const std::vector<double>& keys_s) {
  double shortest_s = kSamplesPerKey * kLongestStep_s;
  for (std::size_t i = 1; i < keys_s.size(); ++i)
    shortest_s = std::min(shortest_s, std::max(keys_s[i] - keys_s[i - 1], kShortestKey_s));
  return shortest_s / kSamplesPerKey;
}

}  // namespace

void describe(config::Fields& fields, ModelCameraOptions& options) {
  fields
      .path("model", options.file,
            "Model file (glTF, FBX, COLLADA and others) that holds the camera, also "
            "archive.zip!/path/in/it.glb.")
      .required();
  fields.value("camera", options.camera,
               "Name of the camera; saccade info lists those of a file. It may be left out where "
               "the file holds one.");
  fields.value("animation", options.animation,
               "Name or index of the animation that moves it; by default the first one of the "
               "file.");
  fields.choice("model_up", options.is_y_up, {{"y", true}, {"z", false}},
                "Axis of the model that points upwards. y turns the path by 90 degrees about x, as "
                "up: y turns a mesh; z leaves it as it is.");
  fields.value("duration_s", options.duration_s, "Duration of the motion, in seconds.")
      .range(1e-6, 3600);
  fields.value("sets_focal_length", options.sets_focal_length,
               "Whether camera.fx and camera.fy are those of its vertical field of view.");
}

std::vector<StampedPose> model_camera_poses(const ModelCameraOptions& options) {
  const Model model = read_model_motion(options.file);
  const ModelCamera& camera = find_camera(model, options);
  const ModelAnimation* const animation = animation_of(model, options, camera.node);
  const NodeAnimation nodes(model.tree, animation);
  const Eigen::Matrix3d turn = upright(options.is_y_up);
  double duration_s = options.duration_s;
  double sampling_s = kLongestStep_s;
  if (animation != nullptr) {
    duration_s = animation->duration_s;
    if (!(duration_s <= kLongest_s))
      throw InputError(options.file.string(),
                       fmt::format("its animation '{}' lasts {:g} s; a motion lasts {:g} s at most",
                                   animation->name, duration_s, kLongest_s));
    std::vector<bool> own(model.tree.size());
    own[static_cast<std::size_t>(camera.node)] = true;
    sampling_s = step_s(nodes.key_times_s(own));
  }
  const double wanted = std::ceil(duration_s / sampling_s - 1e-9);
  if (!(wanted <= kMostPoses))
    throw InputError(options.file.string(),
                     fmt::format("its animation has keys {:g} s apart, which makes {:.0f} poses; "
                                 "{:.0f} at most",
                                 sampling_s * kSamplesPerKey, wanted, kMostPoses));
  const int steps = std::max(2, static_cast<int>(wanted));
  std::vector<StampedPose> poses;
  for (int i = 0; i <= steps; ++i) {
    const double t_s = duration_s * i / steps;
    Eigen::Affine3d world_from_node = Eigen::Affine3d::Identity();
    if (camera.node >= 0)
      world_from_node = nodes.file_from_nodes(t_s)[static_cast<std::size_t>(camera.node)];
    world_from_node = turn * world_from_node;
    poses.push_back({t_s, pose_of(camera, world_from_node, options.file.string())});
  }
  return poses;
}

double model_focal_length_px(const ModelCameraOptions& options, int height_px) {
  const Model model = read_model_motion(options.file);
  const ModelCamera& camera = find_camera(model, options);
  if (!(camera.vertical_fov_rad > 0 && camera.vertical_fov_rad < std::numbers::pi))
    throw InputError(options.file.string(),
                     fmt::format("its camera '{}' states no vertical field of view", camera.name));
  return 0.5 * height_px / std::tan(0.5 * camera.vertical_fov_rad);
}

}  // namespace saccade
