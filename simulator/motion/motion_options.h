#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <vector>

#include <Eigen/Core>

#include "core/config/fields.h"
#include "simulator/motion/model_camera.h"

namespace saccade {

/// Scale, then rotation R = Rz Ry Rx, then translation.
struct TransformOptions {
  Eigen::Vector3d translation = Eigen::Vector3d::Zero();  ///< [m]
  Eigen::Vector3d rotation_deg = Eigen::Vector3d::Zero();
  Eigen::Vector3d scale = Eigen::Vector3d::Ones();  ///< > 0; one number or three
};

void describe(config::Fields& fields, TransformOptions& options);

/// R = Rz Ry Rx; `angles_deg` about x, y and z.
[[nodiscard]] Eigen::Matrix3d rotation_of(const Eigen::Vector3d& angles_deg);

/// Orientation of the camera (x right, y down, z forward): a fixed rotation
///   world_from_camera = Rz Ry Rx
/// or towards a point with `up` upwards in the image. [-90, 0, 0] degrees looks level along +y.
struct PresetOrientation {
  Eigen::Vector3d rotation_deg = Eigen::Vector3d::Zero();
  std::optional<Eigen::Vector3d> look_at;  ///< [m], instead of rotation_deg
  Eigen::Vector3d up = Eigen::Vector3d::UnitZ();
};

/// A waypoint by hand.
struct ViewOptions {
  double t_s = 0;
  Eigen::Vector3d position = Eigen::Vector3d::Zero();  ///< [m]
  PresetOrientation orientation;
};

enum class SpeedProfile {
  kConstant,
  kSmooth,  ///< from rest to rest with the least jerk
};

/// Along a straight line.
struct SliderOptions {
  Eigen::Vector3d from = Eigen::Vector3d::Zero();        ///< [m]
  Eigen::Vector3d direction = Eigen::Vector3d::UnitX();  ///< of any length > 0
  double distance_m = 1;
  SpeedProfile profile = SpeedProfile::kConstant;
  PresetOrientation orientation;
};

/// At constant speed around `centre` in the plane across `normal`, from the direction `start` on,
/// counter-clockwise seen from the normal's tip.
struct CircleOptions {
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();  ///< [m]
  Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();
  Eigen::Vector3d start = Eigen::Vector3d::UnitX();
  double radius_m = 1;
  double revolutions = 1;
  PresetOrientation orientation;
};

/// amplitude * sin(2 pi frequency t + phase) along each axis.
struct Oscillation {
  Eigen::Vector3d amplitude = Eigen::Vector3d::Zero();  ///< [m]
  Eigen::Vector3d frequency_hz = Eigen::Vector3d::Ones();
  Eigen::Vector3d phase_deg = Eigen::Vector3d::Zero();
};

/// Oscillations of position (world axes) and of the rotation vector (camera axes) about a pose.
struct LissajousOptions {
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();  ///< [m]
  PresetOrientation orientation;
  Oscillation position{{0.5, 0.5, 0}, {1, 2, 1}, {0, 90, 0}};
  Oscillation rotation;
};

/// Mostly rotation, as when a hand trembles: about each camera axis a sine with this amplitude and
/// greatest rate, which fix its frequency.
struct ShakeOptions {
  Eigen::Vector3d position = Eigen::Vector3d::Zero();  ///< [m]
  PresetOrientation orientation;
  Eigen::Vector3d rotation_amplitude_deg{5, 5, 5};
  Eigen::Vector3d peak_rate_rad_s{2, 1.6, 1.2};  ///< > 0
  Eigen::Vector3d translation_amplitude_m{0.01, 0.01, 0.01};
};

/// Smooth random motion about a pose: on every axis a sum of sines with random frequencies within
/// the band and random phases.
struct RandomMotionOptions {
  std::uint64_t seed = 1;
  Eigen::Vector3d position = Eigen::Vector3d::Zero();  ///< [m]
  PresetOrientation orientation;
  Eigen::Vector3d position_rms_m{0.2, 0.2, 0.2};
  Eigen::Vector3d rotation_rms_deg{8, 8, 8};
  std::array<double, 2> frequency_hz{0.2, 1.0};
};

enum class MotionSource {
  kControlPoses,
  kWaypoints,
  kFile,
  kModelCamera,
  kSlider,
  kCircle,
  kLissajous,
  kShake,
  kRandom6Dof,
};

enum class Fit { kInterpolate, kSmooth };

/// The `trajectory` section of a simulation, or of a moving object. Only the members of `source`
/// count.
struct MotionOptions {
  MotionSource source = MotionSource::kFile;
  TransformOptions transform;  ///< world from trajectory; one scale factor, which scales positions

  std::vector<std::vector<double>> control_poses;
  std::vector<std::vector<double>> waypoints;
  std::vector<ViewOptions> views;  ///< instead of waypoints
  std::filesystem::path file;
  Fit fit = Fit::kInterpolate;
  double knot_spacing_s = 0.04;
  double rest_s = 0;
  ModelCameraOptions model_camera;

  double duration_s = 1;
  SliderOptions slider;
  CircleOptions circle;
  LissajousOptions lissajous;
  ShakeOptions shake;
  RandomMotionOptions random;
};

void describe(config::Fields& fields, ViewOptions& options);
void describe(config::Fields& fields, MotionOptions& options);

}  // namespace saccade
