#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <vector>

#include <Eigen/Core>

#include "core/camera.h"
#include "core/config/fields.h"
#include "core/rigid3.h"
#include "core/srgb.h"
#include "simulator/motion/motion_options.h"
#include "simulator/scene/scene_options.h"
#include "simulator/sensor/event_options.h"
#include "simulator/sensor/imu/imu.h"

namespace saccade {

/// Frames (section `frames`): frame k shows time k / rate_hz.
struct FrameOptions {
  double rate_hz = 24;
  /// > 0: mean radiance over an exposure of this length centred on the frame's time, cut to the
  /// recording.
  double exposure_s = 0;
  /// Rolling shutter: from the first row's exposure to the last row's. 0: global shutter.
  double readout_s = 0;
  /// What a frame holds: the luminance, linear R, G and B, or the mosaic of a sensor behind Bayer's
  /// filter.
  enum class Colour { kGrey, kRgb, kRggb };
  Colour colour = Colour::kGrey;
  /// What the EXR holds: the exposure that the PNG shows, or the frame's instant, without blur.
  enum class Radiance { kExposed, kInstant };
  Radiance radiance = Radiance::kExposed;
  ToneCurve tone;
};

/// A further camera of a rig (list `rig`), fixed to the first one.
struct RigCameraOptions {
  PinholeCamera camera;
  Rigid3 camera0_from_camera{};  ///< key T_camera0_camera, 4 x 4
  EventOptions events;
};

/// Rates of the ground truth, from time 0 (section `groundtruth`); 0: none.
struct GroundtruthOptions {
  double pose_rate_hz = 1000;
  double depth_rate_hz = 10;
  double flow_rate_hz = 0;
  double masks_rate_hz = 0;
  double normals_rate_hz = 0;
  double optical_flow_rate_hz = 0;
  bool event_labels = false;
  /// Pixels per radian of panorama.exr, what is seen all around at time 0; 0: none.
  double panorama_px_per_rad = 0;
};

/// Everything that `simulate` needs, with all its defaults.
struct SimulationConfig {
  SceneOptions scene;
  MotionOptions trajectory;
  double start_s = 0;
  std::optional<double> duration_s;
  PinholeCamera camera{240, 180, 200, 200, 119.5, 89.5, {}};
  std::optional<std::filesystem::path> sensor;  ///< sensor.yaml, the defaults of `events`
  EventOptions events;
  std::vector<RigCameraOptions> rig;  ///< unless stated with the first camera's lens and pixels
  ImuOptions imu;
  FrameOptions frames;
  GroundtruthOptions groundtruth;
  Eigen::Vector3d gravity_m_s2 = kStandardGravity;
  std::uint64_t seed = 1;
};

void describe(config::Fields& fields, PinholeCamera& camera);
void describe(config::Fields& fields, FrameOptions& options);
void describe(config::Fields& fields, RigCameraOptions& options);
void describe(config::Fields& fields, GroundtruthOptions& options);
void describe(config::Fields& fields, SimulationConfig& config);

}  // namespace saccade
