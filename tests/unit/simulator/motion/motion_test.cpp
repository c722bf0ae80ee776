#include "simulator/motion/motion.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <numbers>

#include "core/config/config.h"
#include "tests/support/command.h"
#include "tests/support/error_of.h"

namespace saccade {
namespace {

using Eigen::Vector3d;
using testing::error_of;
using ::testing::HasSubstr;
using testing::TemporaryFolder;

constexpr double kDegree = std::numbers::pi / 180;

MotionOptions options_of(const std::string& yaml, const std::filesystem::path& folder = {}) {
  return config::read<MotionOptions>(config::parse(yaml, "a.yaml", folder));
}

Spline motion_of(const std::string& yaml) { return build_motion(options_of(yaml)); }

std::string error_in(const std::string& yaml) {
  return error_of([&] { return motion_of(yaml); });
}

void expect_pose(const Rigid3& actual, const Vector3d& position, const Eigen::Quaterniond& rotation,
                 double tolerance = 1e-6) {
  EXPECT_LT((actual.translation() - position).norm(), tolerance)
      << actual.translation().transpose();
  EXPECT_LT(angle_between(actual.rotation(), rotation), tolerance);
}

Eigen::Quaterniond turned(double x_deg, double y_deg, double z_deg) {
  return Eigen::Quaterniond(rotation_of({x_deg, y_deg, z_deg}));
}

// --- poses by hand and from files ---

const char* const kControlPoses =
    "source: control_poses\n"
    "knot_spacing_s: 0.5\n"
    "control_poses: [[0,0,0,0,0,0,1], [1,0,0,0,0,0,1], [2,0,0,0,0,0,1], [3,0,0,0,0,0,1], "
    "[4,0,0,0,0,0,1]]\n";

TEST(Motion, ControlPosesMakeAUniformSpline) {
  const Spline motion = motion_of(kControlPoses);
  EXPECT_EQ(motion.start_s(), 0);
  EXPECT_EQ(motion.end_s(), 1);
  expect_pose(motion.pose(0), {1, 0, 0}, Eigen::Quaterniond::Identity());
  EXPECT_NEAR(motion.state(0.3).velocity_in_world.x(), 2, 1e-12);
}

TEST(Motion, TimedControlPosesKeepTheirTimes) {
  const Spline motion = motion_of(
      "source: control_poses\n"
      "control_poses: [[5,0,0,0,0,0,0,1], [5.5,1,0,0,0,0,0,1], [6,2,0,0,0,0,0,1], "
      "[6.5,3,0,0,0,0,0,1]]\n");
  EXPECT_NEAR(motion.start_s(), 5.5, 1e-12);
  EXPECT_NEAR(motion.end_s(), 6, 1e-12);
  expect_pose(motion.pose(5.5), {1, 0, 0}, Eigen::Quaterniond::Identity());
}

TEST(Motion, PassesThroughWaypoints) {
  const Spline motion = motion_of(
      "source: waypoints\n"
      "waypoints:\n"
      "  - [1, 0, 0, 0, 0, 0, 0, 1]\n"
      "  - [1.5, 1, 2, 3, 0, 0, 0.70710678, 0.70710678]\n"
      "  - [3, -1, 0, 0, 1, 0, 0, 0]\n");
  EXPECT_EQ(motion.start_s(), 1);
  EXPECT_EQ(motion.end_s(), 3);
  expect_pose(motion.pose(1.5), {1, 2, 3}, turned(0, 0, 90));
  expect_pose(motion.pose(3), {-1, 0, 0}, turned(180, 0, 0));
}

TEST(Motion, ViewsLookAtAPointWithUpUpwards) {
  const Spline motion = motion_of(
      "source: waypoints\n"
      "views:\n"
      "  - {t_s: 0, position: [0, -2, 1], look_at: [0, 0, 1]}\n"
      "  - {t_s: 2, position: [3, 0, 0], look_at: [3, 0, -1], up: [0, 1, 0]}\n"
      "  - {t_s: 4, position: [0, 0, 0], rotation_deg: [0, 10, 20]}\n");
  // Level along +y: the camera's x to the right is the world's x, its y down is -z.
  expect_pose(motion.pose(0), {0, -2, 1}, turned(-90, 0, 0));
  const Eigen::Quaterniond down = motion.pose(2).rotation();
  EXPECT_LT((down * Vector3d::UnitZ() - Vector3d(0, 0, -1)).norm(), 1e-6);
  EXPECT_LT((down * Vector3d::UnitY() - Vector3d(0, -1, 0)).norm(), 1e-6);
  expect_pose(motion.pose(4), {0, 0, 0}, turned(0, 10, 20));
}

TEST(Motion, ReadsTextInSecondsAndCsvInNanoseconds) {
  const TemporaryFolder folder;
  std::ofstream(folder.path() / "a.txt")
      << "10 0 0 0 0 0 0 1\n10.5 1 0 0 0 0 0 1\n11 4 0 0 0 0 0 1\n";
  std::ofstream(folder.path() / "a.csv")
      << "# timestamp, x, y, z, qx, qy, qz, qw\n10000000000,0,0,0,0,0,0,1\n"
         "10500000000,1,0,0,0,0,0,1\n11000000000,4,0,0,0,0,0,1\n";
  for (const std::string name : {"a.txt", "a.csv"}) {
    const Spline motion = build_motion(options_of("source: file\nfile: " + name, folder.path()));
    EXPECT_EQ(motion.start_s(), 10);
    EXPECT_EQ(motion.end_s(), 11);
    expect_pose(motion.pose(10.5), {1, 0, 0}, Eigen::Quaterniond::Identity());
    const Spline cut = cut_motion(motion, 0.5, std::nullopt);
    EXPECT_EQ(cut.start_s(), 0);
    EXPECT_NEAR(cut.end_s(), 0.5, 1e-12);
    expect_pose(cut.pose(0), {1, 0, 0}, Eigen::Quaterniond::Identity());
  }
}

TEST(Motion, ARecordedMotionMayBeginWithARest) {
  const TemporaryFolder folder;
  std::ofstream(folder.path() / "a.txt")
      << "10 1 0 0 0 0 0 1\n10.5 1.5 0 0 0 0 0 1\n11 2 0 0 0 0 0 1\n";
  const std::string yaml = "source: file\nfile: a.txt\nrest_s: 2\nfit: ";
  for (const std::string fit : {"interpolate", "smooth"}) {
    const Spline motion = build_motion(options_of(yaml + fit, folder.path()));
    EXPECT_EQ(motion.start_s(), 10);
    EXPECT_NEAR(motion.end_s(), 13, 1e-12);
    for (const double t_s : {10.0, 10.503, 11.0, 11.8}) {
      expect_pose(motion.pose(t_s), {1, 0, 0}, Eigen::Quaterniond::Identity());
      EXPECT_LT(motion.state(t_s).velocity_in_world.norm(), 1e-6) << t_s;
    }
    expect_pose(motion.pose(12.5), {1.5, 0, 0}, Eigen::Quaterniond::Identity(), 1e-3);
  }
}

TEST(Motion, SmoothFitNeedNotPassThroughThePoses) {
  std::string yaml = "source: waypoints\nfit: smooth\nknot_spacing_s: 0.5\nwaypoints:\n";
  for (int i = 0; i <= 40; ++i)
    yaml += "  - [" + std::to_string(0.05 * i) + ", " + std::to_string(i % 2 == 0 ? 0.1 : -0.1) +
            ", 0, 0, 0, 0, 0, 1]\n";
  const Spline motion = motion_of(yaml);
  EXPECT_EQ(motion.segment_count(), 4u);
  for (double t = 0.3; t < 1.7; t += 0.01)
    EXPECT_LT(motion.pose(t).translation().norm(), 0.03) << t;
}

TEST(Motion, TransformScalesThenTurnsThenShifts) {
  const std::string transform =
      "transform: {translation: [1, 2, 3], rotation_deg: [0, 0, 90], scale: 2}\n";
  const Spline motion = motion_of(kControlPoses + transform);
  expect_pose(motion.pose(0), {1, 4, 3}, turned(0, 0, 90));
  const Spline preset =
      motion_of("source: slider\ndirection: [5, 0, 0]\ndistance_m: 3\nrotation_deg: [-90, 0, 0]\n" +
                transform);
  expect_pose(preset.pose(1), {1, 8, 3}, turned(0, 0, 90) * turned(-90, 0, 0));
}

// --- presets ---

TEST(Motion, SliderMovesEvenlyOrFromRestToRest) {
  const std::string slider =
      "source: slider\nfrom: [1, 0, 0]\ndirection: [0, 2, 0]\ndistance_m: 4\nduration_s: 2\n";
  const Spline constant = motion_of(slider);
  EXPECT_EQ(constant.end_s(), 2);
  for (const double t : {0.0, 0.7, 2.0}) {
    expect_pose(constant.pose(t), {1, 2 * t, 0}, Eigen::Quaterniond::Identity());
    EXPECT_LT(constant.state(t).acceleration_in_world.norm(), 1e-6);
  }
  const Spline smooth = motion_of(slider + "profile: smooth\n");
  expect_pose(smooth.pose(1), {1, 2, 0}, Eigen::Quaterniond::Identity());
  for (const double t : {0.0, 2.0}) EXPECT_LT(smooth.state(t).velocity_in_world.norm(), 1e-3);
  EXPECT_NEAR(smooth.state(1).velocity_in_world.y(), 4.0 / 2 * 15 / 8, 1e-4);
}

TEST(Motion, CircleHasItsCentripetalAccelerationAlsoAtTheEnds) {
  const Spline motion = motion_of(
      "source: circle\ncentre: [1, 2, 3]\nradius_m: 0.5\nnormal: [0, 0, 3]\nstart: [1, 0, 5]\n"
      "revolutions: 2\nduration_s: 4\nlook_at: [1, 2, 3]\n");
  const double w = std::numbers::pi;
  for (const double t : {0.0, 0.25, 1.7, 4.0}) {
    const Vector3d out(std::cos(w * t), std::sin(w * t), 0);
    const SplineState state = motion.state(t);
    EXPECT_LT((state.world_from_body.translation() - Vector3d(1, 2, 3) - 0.5 * out).norm(), 1e-6);
    EXPECT_LT((state.acceleration_in_world + 0.5 * w * w * out).norm(), 2e-3) << t;
    EXPECT_LT((state.world_from_body.rotation() * Vector3d::UnitZ() + out).norm(), 1e-6);
    // Turning about the world's z, which is up: -y of the camera.
    EXPECT_LT((state.angular_velocity_in_body - Vector3d(0, -w, 0)).norm(), 1e-5);
  }
}

TEST(Motion, LissajousOscillatesInPositionAndRotation) {
  const Spline motion = motion_of(
      "source: lissajous\ncentre: [0, 0, 1]\namplitude_m: [1, 2, 0]\nfrequency_hz: [1, 2, 0]\n"
      "phase_deg: [0, 90, 0]\nrotation_amplitude_deg: [0, 20, 0]\nduration_s: 2\n"
      "rotation_deg: [-90, 0, 0]\n");
  const double turn = 2 * std::numbers::pi;
  for (const double t : {0.0, 0.31, 1.9}) {
    expect_pose(motion.pose(t), {std::sin(turn * t), 2 * std::cos(2 * turn * t), 1},
                turned(-90, 0, 0) * so3_exp({0, 20 * kDegree * std::sin(turn * t), 0}));
  }
}

TEST(Motion, ShakeReachesItsPeakRateAndAmplitude) {
  const Spline motion = motion_of(
      "source: shake\nduration_s: 5\nrotation_amplitude_deg: [3, 0, 0]\n"
      "peak_rate_rad_s: [2.5, 1, 1]\n");
  double rate = 0, angle = 0, shift = 0;
  for (double t = 0; t < 5; t += 0.001) {
    const SplineState state = motion.state(t);
    rate = std::max(rate, state.angular_velocity_in_body.norm());
    angle = std::max(angle, angle_between(state.world_from_body.rotation(), turned(0, 0, 0)));
    shift = std::max(shift, state.world_from_body.translation().cwiseAbs().maxCoeff());
  }
  EXPECT_NEAR(rate, 2.5, 1e-3);
  EXPECT_NEAR(angle, 3 * kDegree, 1e-5);
  EXPECT_NEAR(shift, 0.01, 1e-5);
}

TEST(Motion, RandomMotionHasItsStrengthAndRepeatsWithItsSeed) {
  const std::string yaml =
      "source: random_6dof\nduration_s: 100\nposition: [1, 1, 1]\nposition_rms_m: [0.3, 0.1, 0]\n"
      "rotation_rms_deg: [0, 5, 0]\nfrequency_hz: [0.5, 1.5]\n";
  const Spline motion = motion_of(yaml + "seed: 4\n");
  const Spline again = motion_of(yaml + "seed: 4\n");
  const Spline other = motion_of(yaml + "seed: 5\n");
  Vector3d squares = Vector3d::Zero();
  double turns = 0;
  for (int i = 0; i < 1000; ++i) {
    const Rigid3 pose = motion.pose(0.1 * i);
    squares += (pose.translation() - Vector3d::Ones()).cwiseAbs2() / 1000;
    turns += so3_log(pose.rotation()).squaredNorm() / 1000;
    EXPECT_EQ(pose.translation(), again.pose(0.1 * i).translation());
  }
  EXPECT_NEAR(std::sqrt(squares.x()), 0.3, 0.03);
  EXPECT_NEAR(std::sqrt(squares.y()), 0.1, 0.01);
  EXPECT_LT(squares.z(), 1e-12);
  EXPECT_NEAR(std::sqrt(turns), 5 * kDegree, 0.5 * kDegree);
  EXPECT_GT((motion.pose(7).translation() - other.pose(7).translation()).norm(), 1e-3);
}

TEST(Motion, PrintedOptionsReadBackToTheSameMotion) {
  for (const std::string& yaml :
       {std::string(kControlPoses), std::string("source: circle\nlook_at: [1, 2, 3]\n"),
        std::string("source: random_6dof\nseed: 9\nfrequency_hz: [1, 2]\n")}) {
    const MotionOptions options = options_of(yaml);
    const Spline a = build_motion(options);
    const Spline b = motion_of(config::print(options));
    for (const double t : {0.0, 0.4, 1.0}) {
      EXPECT_EQ(a.pose(t).translation(), b.pose(t).translation()) << yaml;
    }
  }
}

// --- pieces and errors ---

TEST(Motion, CutsAPieceThatStartsAtZero) {
  const Spline motion = motion_of("source: slider\ndistance_m: 2\nduration_s: 2\n");
  const Spline piece = cut_motion(motion, 0.5, 1.0);
  EXPECT_EQ(piece.start_s(), 0);
  EXPECT_EQ(piece.end_s(), 1);
  expect_pose(piece.pose(0.25), {0.75, 0, 0}, Eigen::Quaterniond::Identity());
  EXPECT_NEAR(cut_motion(motion, 0, 2.0000005).end_s(), 2, 1e-12);
}

TEST(Motion, ACutBeyondTheSpanNamesTheSpan) {
  const Spline motion = motion_of("source: slider\nduration_s: 2\n");
  const auto cut = [&](double start, std::optional<double> duration) {
    return error_of([&] { return cut_motion(motion, start, duration); });
  };
  EXPECT_THAT(cut(0, 3), AllOf(HasSubstr("duration_s: 3 s"), HasSubstr("lasts 2 s")));
  EXPECT_THAT(cut(1.5, 1), HasSubstr("from 1.5 s on"));
  EXPECT_THAT(cut(2, std::nullopt), AllOf(HasSubstr("start_s: 2 s"), HasSubstr("lasts 2 s")));
  EXPECT_THAT(cut(-1, std::nullopt), HasSubstr("start_s"));
  EXPECT_THAT(cut(0, 0), HasSubstr("duration_s"));
}

TEST(Motion, BadWaypointsNameTheirPlaceAndItem) {
  const std::string head = "source: waypoints\nwaypoints: ";
  EXPECT_THAT(error_in(head + "[[0,0,0,0,0,0,0,1]]"), HasSubstr("a.yaml:2: waypoints: expected"));
  EXPECT_THAT(error_in(head + "[[0,0,0,0,0,0,0,1], [0,0,0,0,0,0,0,1]]"),
              AllOf(HasSubstr("a.yaml:2"), HasSubstr("item 1: times must increase")));
  EXPECT_THAT(error_in(head + "[[0,0,0,0,0,0,0,1], [1,0,0,0,0,0,0,2]]"),
              HasSubstr("item 1: the quaternion"));
  EXPECT_THAT(error_in(head + "[[0,0,0,0,0,0,0,1], [1,0,.nan,0,0,0,0,1]]"),
              HasSubstr("a.yaml:2: waypoints[1][2]"));
  EXPECT_THAT(error_in(head + "[[0,0,0,0,0,0,1], [1,0,0,0,0,0,1]]"), HasSubstr("waypoints[0]"));
  EXPECT_THAT(error_in("source: waypoints\n"), HasSubstr("waypoints"));
}

TEST(Motion, BadControlPosesNameTheirPlaceAndItem) {
  const std::string head = "source: control_poses\ncontrol_poses: ";
  EXPECT_THAT(error_in(head + "[[0,0,0,0,0,0,1], [0,0,0,0,0,0,1]]"), HasSubstr("a.yaml:2"));
  EXPECT_THAT(error_in(head + "[[0,0,0,0,0,0,0,1], [1,0,0,0,0,0,0,1], [2,0,0,0,0,0,0,1], "
                              "[3.5,0,0,0,0,0,0,1]]"),
              HasSubstr("item 3: control poses must be evenly spaced in time; 3 s is expected"));
}

TEST(Motion, BadPresetsNameTheKey) {
  EXPECT_THAT(error_in("source: slyder\n"), HasSubstr("'slider'"));
  EXPECT_THAT(error_in("duration_s: 2\n"), HasSubstr("source"));
  EXPECT_THAT(error_in("source: slider\nradius_m: 2\n"),
              AllOf(HasSubstr("a.yaml:2"), HasSubstr("radius_m"), HasSubstr("circle")));
  EXPECT_THAT(error_in("source: slider\nduration_s: 0\n"), HasSubstr("duration_s"));
  EXPECT_THAT(error_in("source: slider\ndirection: [0, 0, 0]\n"), HasSubstr("direction"));
  EXPECT_THAT(error_in("source: circle\nstart: [0, 0, 1]\n"), HasSubstr("start"));
  EXPECT_THAT(error_in("source: random_6dof\nfrequency_hz: [2, 1]\n"), HasSubstr("frequency_hz"));
  EXPECT_THAT(error_in("source: circle\nlook_at: [0, 0, 1]\nrotation_deg: [0, 0, 1]\n"),
              HasSubstr("cannot be combined with look_at"));
  EXPECT_THAT(error_in("source: slider\nlook_at: [0.5, 0, 0]\n"), HasSubstr("look_at"));
  EXPECT_THAT(error_in("source: slider\ntransform: {scale: [1, 2, 1]}\n"), HasSubstr("scale"));
}

TEST(Motion, BadFilesNameTheFile) {
  EXPECT_THAT(error_in("source: file\nfile: nowhere.txt\n"),
              AllOf(HasSubstr("a.yaml:2"), HasSubstr("nowhere.txt")));
  const TemporaryFolder folder;
  const auto error_for = [&](const std::string& text) {
    std::ofstream(folder.path() / "a.txt") << text;
    return error_of(
        [&] { return build_motion(options_of("source: file\nfile: a.txt", folder.path())); });
  };
  EXPECT_THAT(error_for("0 0 0 0 0 0 0 1\n"), AllOf(HasSubstr("a.txt"), HasSubstr("at least two")));
  EXPECT_THAT(error_for("0 0 0 0 0 0 0 1\n0 0 0 0 0 0 0 1\n"), HasSubstr("a.txt:2"));
}

}  // namespace
}  // namespace saccade
