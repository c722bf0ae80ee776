#include "simulator/motion/motion_options.h"

#include <fmt/format.h>

#include <Eigen/Geometry>

#include <cmath>

namespace saccade {
namespace {

constexpr double kUnitTolerance = 1e-3;

/// The keys stand beside those of the position, not in a section of their own.
void describe_orientation(config::Fields& fields, PresetOrientation& options) {
  const bool looks =
      fields.reading() ? fields.has("look_at") || fields.has("up") : options.look_at.has_value();
  if (looks) {
    fields.value("look_at", options.look_at, "point in the middle of the picture [m]").required();
    fields.value("up", options.up, "direction that is up in the picture");
    fields.expect(options.up.norm() > 0, "up", "must not be zero");
    fields.expect(!fields.has("rotation_deg"), "rotation_deg", "cannot be combined with look_at");
  } else {
    fields.value("rotation_deg", options.rotation_deg,
                 "of the camera (z forward, y down): R = Rz Ry Rx");
  }
}

void describe_slider(config::Fields& fields, SliderOptions& options) {
  fields.value("from", options.from, "position at the start [m]");
  fields.value("direction", options.direction, "of the motion; its length does not matter");
  fields.expect(options.direction.norm() > 0, "direction", "must not be zero");
  fields.value("distance_m", options.distance_m, "length of the way").at_least(0);
  fields.choice("profile", options.profile,
                {{"constant", SpeedProfile::kConstant}, {"smooth", SpeedProfile::kSmooth}},
                "speed over time; smooth starts and ends at rest");
  describe_orientation(fields, options.orientation);
}

void describe_circle(config::Fields& fields, CircleOptions& options) {
  fields.value("centre", options.centre, "centre of the circle [m]");
  fields.value("normal", options.normal, "across the circle's plane");
  fields.value("start", options.start, "direction from the centre to the first position");
  fields.expect(options.normal.norm() > 0, "normal", "must not be zero");
  fields.expect(options.normal.cross(options.start).norm() >
                    1e-6 * options.normal.norm() * options.start.norm(),
                "start", "must not be parallel to the normal");
  fields.value("radius_m", options.radius_m, "radius").above(0);
  fields.value("revolutions", options.revolutions,
               "turns within duration_s, counter-clockwise seen from the normal's tip");
  describe_orientation(fields, options.orientation);
}

void describe_lissajous(config::Fields& fields, LissajousOptions& options) {
  fields.value("centre", options.centre, "mean position [m]");
  fields.value("amplitude_m", options.position.amplitude, "of the position along x, y, z");
  fields.value("frequency_hz", options.position.frequency_hz, "along x, y, z").range(0, 1000);
  fields.value("phase_deg", options.position.phase_deg, "along x, y, z");
  fields.value("rotation_amplitude_deg", options.rotation.amplitude, "about the camera's axes");
  fields.value("rotation_frequency_hz", options.rotation.frequency_hz, "about the camera's axes")
      .range(0, 1000);
  fields.value("rotation_phase_deg", options.rotation.phase_deg, "about the camera's axes");
  describe_orientation(fields, options.orientation);
}

void describe_shake(config::Fields& fields, ShakeOptions& options) {
  fields.value("position", options.position, "mean position [m]");
  fields.value("rotation_amplitude_deg", options.rotation_amplitude_deg, "about the camera's axes")
      .at_least(0);
  fields.value("peak_rate_rad_s", options.peak_rate_rad_s, "greatest rate about the camera's axes")
      .above(0);
  fields.value("translation_amplitude_m", options.translation_amplitude_m, "along x, y, z")
      .at_least(0);
  fields.value("translation_frequency_hz", options.translation_frequency_hz, "along x, y, z")
      .range(0, 1000);
  describe_orientation(fields, options.orientation);
}

void describe_random(config::Fields& fields, RandomMotionOptions& options) {
  fields.value("seed", options.seed, "of the motion");
  fields.value("position", options.position, "mean position [m]");
  fields.value("position_rms_m", options.position_rms_m, "strength along x, y, z").at_least(0);
  fields.value("rotation_rms_deg", options.rotation_rms_deg, "strength about the camera's axes")
      .range(0, 60);
  fields.value("frequency_hz", options.frequency_hz, "lowest and highest frequency")
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
             "each tx ty tz qx qy qz qw, or t and these at even times")
      .required()
      .length(4, config::Rule::kAnyLength)
      .item_length(7, 8);
  const auto& poses = options.control_poses;
  for (std::size_t i = 0; i < poses.size(); ++i) {
    fields.expect(poses[i].size() == poses[0].size(), "control_poses",
                  "must be all with or all without a time");
    expect_none(fields, "control_poses", quaternion_problem(poses[i], i));
  }
  const bool timed = !poses.empty() && poses[0].size() == 8;
  if (!timed) {
    fields.value("knot_spacing_s", options.knot_spacing_s, "time between control poses").above(0);
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
    fields.list("views", options.views, "waypoints, each with t_s, position and orientation")
        .length(2, config::Rule::kAnyLength);
    for (std::size_t i = 1; i < options.views.size(); ++i)
      expect_none(fields, "views",
                  order_problem(options.views[i - 1].t_s, options.views[i].t_s, i));
    return;
  }
  fields.value("waypoints", options.waypoints, "each t tx ty tz qx qy qz qw [s, m]")
      .required()
      .length(2, config::Rule::kAnyLength)
      .item_length(8, 8);
  const auto& poses = options.waypoints;
  for (std::size_t i = 0; i < poses.size(); ++i) {
    expect_none(fields, "waypoints", quaternion_problem(poses[i], i));
    if (i > 0) expect_none(fields, "waypoints", order_problem(poses[i - 1][0], poses[i][0], i));
  }
}

void describe_fit(config::Fields& fields, MotionOptions& options) {
  fields.choice("fit", options.fit, {{"interpolate", Fit::kInterpolate}, {"smooth", Fit::kSmooth}},
                "through every pose, or least squares for recorded motion");
  if (options.fit == Fit::kSmooth)
    fields.value("knot_spacing_s", options.knot_spacing_s, "knots of the smooth spline").above(0);
}

void describe_preset(config::Fields& fields, MotionOptions& options) {
  fields.value("duration_s", options.duration_s, "how long the motion lasts")
      .above(0)
      .at_most(3600);
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

void describe(config::Fields& fields, ViewOptions& options) {
  fields.value("t_s", options.t_s, "time of the waypoint").required();
  fields.value("position", options.position, "of the camera [m]").required();
  describe_orientation(fields, options.orientation);
}

void describe(config::Fields& fields, MotionOptions& options) {
  fields
      .choice("source", options.source,
              {{"control_poses", MotionSource::kControlPoses},
               {"waypoints", MotionSource::kWaypoints},
               {"file", MotionSource::kFile},
               {"slider", MotionSource::kSlider},
               {"circle", MotionSource::kCircle},
               {"lissajous", MotionSource::kLissajous},
               {"shake", MotionSource::kShake},
               {"random_6dof", MotionSource::kRandom6Dof}},
              "where the motion comes from")
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
      fields.path("file", options.file, "TUM or ECD text in s, or rpg_esim's CSV in ns")
          .required()
          .must_exist();
      fields.value("rest_s", options.rest_s, "the camera stands at the first pose before it moves")
          .range(0, 3600);
      describe_fit(fields, options);
      break;
    default:
      describe_preset(fields, options);
  }
  fields.section("transform", options.transform, "places the motion in the scene");
  const Eigen::Vector3d& scale = options.transform.scale;
  fields.expect((scale.array() == scale.x()).all(), "transform",
                "a trajectory's scale is one number");
}

}  // namespace saccade
