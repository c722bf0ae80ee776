#include "simulator/motion/motion_options.h"

#include <fmt/format.h>

#include <Eigen/Geometry>

#include <cmath>
#include <numbers>

namespace saccade {
namespace {

constexpr double kUnitTolerance = 1e-3;
/// Ranges that only mistakes leave.
constexpr double kFarthest_m = 1e6;
constexpr double kLargest_deg = 36000;
constexpr double kLargestEntry = 1e10;  // of a pose: seconds, metres or a quaternion

/// The keys stand beside those of the position, not in a section of their own.
void describe_orientation(config::Fields& fields, PresetOrientation& options) {
  const bool has_target =
      fields.reading() ? fields.has("look_at") || fields.has("up") : options.look_at.has_value();
  if (has_target) {
    fields
        .value(
            "look_at", options.look_at,
            "Point in the world that stays at the principal point, in metres; it stands in place "
            "of rotation_deg, and up needs it.")
        .range(-kFarthest_m, kFarthest_m)
        .required();
    fields.value("up", options.up, "Direction in the world that points upwards in the image.")
        .range(-kFarthest_m, kFarthest_m);
    fields.expect(options.up.norm() > 0, "up", "must not be zero");
    fields.expect(!fields.has("rotation_deg"), "rotation_deg", "cannot be combined with look_at");
  } else {
    fields
        .value("rotation_deg", options.rotation_deg,
               "Rotation of the camera (z forward, y down) about x, then y, then z, in degrees: R "
               "= Rz Ry Rx.")
        .range(-kLargest_deg, kLargest_deg);
  }
}

void describe_slider(config::Fields& fields, SliderOptions& options) {
  fields.value("from", options.from, "Position at the start, in metres.")
      .range(-kFarthest_m, kFarthest_m);
  fields
      .value("direction", options.direction, "Direction of the motion; its length does not matter.")
      .range(-kFarthest_m, kFarthest_m);
  fields.expect(options.direction.norm() > 0, "direction", "must not be zero");
  fields.value("distance_m", options.distance_m, "Length of the path, in metres.").at_least(0);
  fields.choice("profile", options.profile,
                {{"constant", SpeedProfile::kConstant}, {"smooth", SpeedProfile::kSmooth}},
                "Speed over time: constant, or smooth, which starts and ends at rest.");
  describe_orientation(fields, options.orientation);
}

void describe_circle(config::Fields& fields, CircleOptions& options) {
  fields.value("centre", options.centre, "Centre of the circle, in metres.")
      .range(-kFarthest_m, kFarthest_m);
  fields.value("normal", options.normal, "Normal of the plane of the circle.")
      .range(-kFarthest_m, kFarthest_m);
  fields.value("start", options.start, "Direction from the centre to the first position.")
      .range(-kFarthest_m, kFarthest_m);
  fields.expect(options.normal.norm() > 0, "normal", "must not be zero");
  fields.expect(options.normal.cross(options.start).norm() >
                    1e-6 * options.normal.norm() * options.start.norm(),
                "start", "must not be parallel to the normal");
  fields.value("radius_m", options.radius_m, "Radius of the circle, in metres.").above(0);
  fields
      .value("revolutions", options.revolutions,
             "Number of revolutions within duration_s, counter-clockwise as seen against the "
             "normal; negative values are clockwise.")
      .range(-1e6, 1e6);
  describe_orientation(fields, options.orientation);
}

void describe_lissajous(config::Fields& fields, LissajousOptions& options) {
  fields.value("centre", options.centre, "Mean position, in metres.")
      .range(-kFarthest_m, kFarthest_m);
  fields
      .value("amplitude_m", options.position.amplitude,
             "Amplitudes of the position along x, y and z, in metres.")
      .range(-kFarthest_m, kFarthest_m);
  fields
      .value("frequency_hz", options.position.frequency_hz,
             "Frequencies of the position along x, y and z, in hertz.")
      .range(0, 1000);
  fields
      .value("phase_deg", options.position.phase_deg,
             "Phases of the position along x, y and z at time 0, in degrees.")
      .range(-kLargest_deg, kLargest_deg);
  fields
      .value("rotation_amplitude_deg", options.rotation.amplitude,
             "Amplitudes of the rotation about the axes of the camera, in degrees.")
      .range(-kLargest_deg, kLargest_deg);
  fields
      .value("rotation_frequency_hz", options.rotation.frequency_hz,
             "Frequencies of the rotation about the axes of the camera, in hertz.")
      .range(0, 1000);
  fields
      .value("rotation_phase_deg", options.rotation.phase_deg,
             "Phases of the rotation about the axes of the camera at time 0, in degrees.")
      .range(-kLargest_deg, kLargest_deg);
  describe_orientation(fields, options.orientation);
}

void describe_shake(config::Fields& fields, ShakeOptions& options) {
  fields.value("position", options.position, "Mean position, in metres.")
      .range(-kFarthest_m, kFarthest_m);
  fields
      .value("rotation_amplitude_deg", options.rotation_amplitude_deg,
             "Amplitudes of the rotation about the axes of the camera, in degrees.")
      .at_least(0);
  fields
      .value("peak_rate_rad_s", options.peak_rate_rad_s,
             "Largest angular velocities about the axes of the camera, in rad/s; with the "
             "amplitudes they fix the frequencies.")
      .above(0);
  fields
      .value("translation_amplitude_m", options.translation_amplitude_m,
             "Amplitudes of the translation along x, y and z, in metres.")
      .at_least(0);
  describe_orientation(fields, options.orientation);
}

void describe_random(config::Fields& fields, RandomMotionOptions& options) {
  fields
      .value("seed", options.seed, "Seed of the random motion; another seed gives another motion.")
      .at_least(0);
  fields.value("position", options.position, "Mean position, in metres.")
      .range(-kFarthest_m, kFarthest_m);
  fields
      .value("position_rms_m", options.position_rms_m,
             "Root mean square of the translation along x, y and z, in metres.")
      .at_least(0);
  fields
      .value("rotation_rms_deg", options.rotation_rms_deg,
             "Root mean square of the rotation about the axes of the camera, in degrees.")
      .range(0, 60);
  fields
      .value("frequency_hz", options.frequency_hz,
             "Lowest and highest frequency of the motion, in hertz.")
      .range(0.001, 1000);
  fields.expect(options.frequency_hz[0] <= options.frequency_hz[1], "frequency_hz",
                "must be [lowest, highest]");
  describe_orientation(fields, options.orientation);
}

/// What is wrong with the last four numbers of a pose; empty when nothing.
std::string quaternion_problem(const std::vector<double>& pose, std::size_t index) {
  const Eigen::Map<const Eigen::Vector4d> q(&pose[pose.size() - 4]);
  if (std::abs(q.norm() - 1) <= kUnitTolerance) return {};
  return fmt::format("item {}: the quaternion qx qy qz qw has length {:.6g}; a rotation's is 1",
                     index, q.norm());
}

std::string order_problem(double before, double t, std::size_t index) {
  if (t > before) return {};
  return fmt::format("item {}: times must increase, {} s comes after {} s", index, t, before);
}

/// Control poses have knots of their own only at even times.
std::string spacing_problem(const std::vector<std::vector<double>>& poses, std::size_t index) {
  const double spacing = poses[1][0] - poses[0][0];
  const double expected = poses[0][0] + static_cast<double>(index) * spacing;
  if (std::abs(poses[index][0] - expected) <= 1e-3 * spacing) return {};
  return fmt::format("item {}: control poses must be evenly spaced in time; {} s is expected",
                     index, expected);
}

void expect_none(config::Fields& fields, const char* key, const std::string& problem) {
  fields.expect(problem.empty(), key, problem);
}

void describe_control_poses(config::Fields& fields, MotionOptions& options) {
  fields
      .value("control_poses", options.control_poses,
             "Control poses of the spline, each tx ty tz qx qy qz qw, or t before these at evenly "
             "spaced times.")
      .required()
      .length(4, config::Rule::kAnyLength)
      .item_length(7, 8)
      .range(-kLargestEntry, kLargestEntry);
  const auto& poses = options.control_poses;
  for (std::size_t i = 0; i < poses.size(); ++i) {
    fields.expect(poses[i].size() == poses[0].size(), "control_poses",
                  "must be all with or all without a time");
    expect_none(fields, "control_poses", quaternion_problem(poses[i], i));
  }
  const bool timed = !poses.empty() && poses[0].size() == 8;
  if (!timed) {
    fields
        .value("knot_spacing_s", options.knot_spacing_s,
               "Time between two control poses, in seconds.")
        .above(0);
    return;
  }
  for (std::size_t i = 1; i < poses.size(); ++i) {
    expect_none(fields, "control_poses", order_problem(poses[i - 1][0], poses[i][0], i));
    expect_none(fields, "control_poses", spacing_problem(poses, i));
  }
}

void describe_waypoints(config::Fields& fields, MotionOptions& options) {
  const bool views = fields.reading() ? fields.has("views") : !options.views.empty();
  if (views) {
    fields
        .list("views", options.views,
              "Waypoints by hand, each with its time, position and orientation.")
        .length(2, config::Rule::kAnyLength);
    for (std::size_t i = 1; i < options.views.size(); ++i)
      expect_none(fields, "views",
                  order_problem(options.views[i - 1].t_s, options.views[i].t_s, i));
    return;
  }
  fields
      .value("waypoints", options.waypoints,
             "Waypoints, each t tx ty tz qx qy qz qw, in seconds and metres.")
      .required()
      .length(2, config::Rule::kAnyLength)
      .item_length(8, 8)
      .range(-kLargestEntry, kLargestEntry);
  const auto& poses = options.waypoints;
  for (std::size_t i = 0; i < poses.size(); ++i) {
    expect_none(fields, "waypoints", quaternion_problem(poses[i], i));
    if (i > 0) expect_none(fields, "waypoints", order_problem(poses[i - 1][0], poses[i][0], i));
  }
}

void describe_fit(config::Fields& fields, MotionOptions& options) {
  fields.choice(
      "fit", options.fit, {{"interpolate", Fit::kInterpolate}, {"smooth", Fit::kSmooth}},
      "Whether the spline passes through every pose, or fits recorded motion in least squares.");
  if (options.fit == Fit::kSmooth)
    fields
        .value(
            "knot_spacing_s", options.knot_spacing_s,
            "Time between two knots of the smooth spline, in seconds; larger values smooth more.")
        .above(0);
}

void describe_preset(config::Fields& fields, MotionOptions& options) {
  fields.value("duration_s", options.duration_s, "Duration of the motion, in seconds.")
      .range(1e-6, 3600);
  switch (options.source) {
    case MotionSource::kSlider:
      return describe_slider(fields, options.slider);
    case MotionSource::kCircle:
      return describe_circle(fields, options.circle);
    case MotionSource::kLissajous:
      return describe_lissajous(fields, options.lissajous);
    case MotionSource::kShake:
      return describe_shake(fields, options.shake);
    default:
      return describe_random(fields, options.random);
  }
}

}  // namespace

void describe(config::Fields& fields, TransformOptions& options) {
  fields.value("translation", options.translation, "Translation, in metres.").range(-1e6, 1e6);
  fields
      .value("rotation_deg", options.rotation_deg, "Rotation about x, then y, then z, in degrees.")
      .range(-36000, 36000);
  constexpr double kLeastScale = 1e-9;
  constexpr double kLargestScale = 1e9;
  const char* const help = "Scale before the rotation: one factor, or one each for x, y and z.";
  const Eigen::Vector3d& scale = options.scale;
  const bool one_number = fields.reading() ? fields.form("scale") != config::Form::kList
                                           : scale.x() == scale.y() && scale.x() == scale.z();
  if (one_number) {
    double factor = scale.x();
    fields.value("scale", factor, help).range(kLeastScale, kLargestScale);
    options.scale.setConstant(factor);
  } else {
    fields.value("scale", options.scale, help).range(kLeastScale, kLargestScale);
  }
}

Eigen::Matrix3d rotation_of(const Eigen::Vector3d& angles_deg) {
  const Eigen::Vector3d angles = angles_deg * (std::numbers::pi / 180);
  return (Eigen::AngleAxisd(angles.z(), Eigen::Vector3d::UnitZ()) *
          Eigen::AngleAxisd(angles.y(), Eigen::Vector3d::UnitY()) *
          Eigen::AngleAxisd(angles.x(), Eigen::Vector3d::UnitX()))
      .toRotationMatrix();
}

void describe(config::Fields& fields, ViewOptions& options) {
  fields.value("t_s", options.t_s, "Time of the waypoint, in seconds.").range(-1e9, 1e9).required();
  fields.value("position", options.position, "Position of the camera, in metres.")
      .range(-kFarthest_m, kFarthest_m)
      .required();
  describe_orientation(fields, options.orientation);
}

void describe(config::Fields& fields, MotionOptions& options) {
  fields
      .choice("source", options.source,
              {{"control_poses", MotionSource::kControlPoses},
               {"waypoints", MotionSource::kWaypoints},
               {"file", MotionSource::kFile},
               {"model_camera", MotionSource::kModelCamera},
               {"slider", MotionSource::kSlider},
               {"circle", MotionSource::kCircle},
               {"lissajous", MotionSource::kLissajous},
               {"shake", MotionSource::kShake},
               {"random_6dof", MotionSource::kRandom6Dof}},
              "Source of the motion.")
      .required();
  switch (options.source) {
    case MotionSource::kControlPoses:
      describe_control_poses(fields, options);
      break;
    case MotionSource::kWaypoints:
      describe_waypoints(fields, options);
      describe_fit(fields, options);
      break;
    case MotionSource::kFile:
      fields
          .path("file", options.file,
                "File of poses: TUM or ECD text in seconds, or the CSV of rpg_esim in nanoseconds.")
          .required()
          .must_exist();
      fields
          .value("rest_s", options.rest_s,
                 "Time for which the camera rests at the first pose before it moves, in seconds.")
          .range(0, 3600);
      describe_fit(fields, options);
      break;
    case MotionSource::kModelCamera:
      describe(fields, options.model_camera);
      describe_fit(fields, options);
      break;
    default:
      describe_preset(fields, options);
  }
  fields.section("transform", options.transform, "Transform of the trajectory into the scene.");
  const Eigen::Vector3d& scale = options.transform.scale;
  fields.expect((scale.array() == scale.x()).all(), "transform",
                "a trajectory's scale is one number");
}

}  // namespace saccade
