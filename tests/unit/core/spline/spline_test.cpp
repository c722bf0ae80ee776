#include "core/spline/spline.h"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "core/io/trajectory_file.h"
#include "core/random.h"
#include "tests/support/shared_data.h"

namespace saccade {
namespace {

using Eigen::Vector3d;

constexpr double kDegree = std::numbers::pi / 180;

/// Poses at uneven times; consecutive rotations up to `max_turn` rad apart about any axis.
std::vector<StampedPose> random_poses(std::size_t count, double max_turn, std::uint64_t seed) {
  const Random random(seed);
  const auto draw = [&](std::uint64_t stream, std::size_t i) {
    return 2 * random.uniform(stream, i) - 1;
  };
  std::vector<StampedPose> poses;
  Eigen::Quaterniond rotation = Eigen::Quaterniond::Identity();
  double t = 3;
  for (std::size_t i = 0; i < count; ++i) {
    const Vector3d axis = Vector3d(draw(0, i), draw(1, i), draw(2, i)).normalized();
    rotation = rotation * so3_exp(max_turn * random.uniform(3, i) * axis);
    poses.push_back({t, {rotation, {draw(4, i), draw(5, i), draw(6, i)}}});
    t += 0.05 + 0.5 * random.uniform(7, i);
  }
  return poses;
}

void expect_passes_through(const Spline& spline, const std::vector<StampedPose>& poses,
                           double tolerance) {
  for (const StampedPose& p : poses) {
    const Rigid3 pose = spline.pose(p.t_s);
    EXPECT_LT((pose.translation() - p.world_from_camera.translation()).norm(), tolerance) << p.t_s;
    EXPECT_LT(angle_between(pose.rotation(), p.world_from_camera.rotation()), tolerance) << p.t_s;
  }
}

/// Analytic derivatives against central differences of pose() at times inside segments.
void expect_derivatives(const Spline& spline, double t, double tolerance) {
  constexpr double h = 1e-4;
  const SplineState at = spline.state(t);
  const Rigid3 before = spline.pose(t - h);
  const Rigid3 after = spline.pose(t + h);
  const Vector3d p = at.world_from_body.translation();
  const Vector3d velocity = (after.translation() - before.translation()) / (2 * h);
  const Vector3d acceleration = (after.translation() - 2 * p + before.translation()) / (h * h);
  EXPECT_LT((at.velocity_in_world - velocity).norm(), tolerance) << t;
  EXPECT_LT((at.acceleration_in_world - acceleration).norm(), 100 * tolerance) << t;
  const Eigen::Quaterniond back = at.world_from_body.rotation().conjugate();
  const Vector3d omega =
      (so3_log(back * after.rotation()) - so3_log(back * before.rotation())) / (2 * h);
  EXPECT_LT((at.angular_velocity_in_body - omega).norm(), tolerance) << t;
  const Vector3d alpha = (spline.state(t + h).angular_velocity_in_body -
                          spline.state(t - h).angular_velocity_in_body) /
                         (2 * h);
  EXPECT_LT((at.angular_acceleration_in_body - alpha).norm(), 100 * tolerance) << t;
}

/// Nothing but the third derivative may jump at `t`.
void expect_twice_continuous(const Spline& spline, double t) {
  const SplineState a = spline.state(t - 1e-9);
  const SplineState b = spline.state(t + 1e-9);
  EXPECT_LT((a.world_from_body.translation() - b.world_from_body.translation()).norm(), 1e-6);
  EXPECT_LT(angle_between(a.world_from_body.rotation(), b.world_from_body.rotation()), 1e-6);
  EXPECT_LT((a.velocity_in_world - b.velocity_in_world).norm(), 1e-5);
  EXPECT_LT((a.acceleration_in_world - b.acceleration_in_world).norm(), 1e-4);
  EXPECT_LT((a.angular_velocity_in_body - b.angular_velocity_in_body).norm(), 1e-5);
  EXPECT_LT((a.angular_acceleration_in_body - b.angular_acceleration_in_body).norm(), 1e-4);
}

TEST(SplineInterpolate, PassesThroughEveryPose) {
  const auto poses = random_poses(40, 60 * kDegree, 1);
  const Spline spline = Spline::interpolate(poses);
  EXPECT_EQ(spline.start_s(), poses.front().t_s);
  EXPECT_EQ(spline.end_s(), poses.back().t_s);
  expect_passes_through(spline, poses, 1e-9);
}

TEST(SplineInterpolate, PassesThroughTurnsOf150DegreesAboutAnyAxis) {
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    const auto poses = random_poses(30, 150 * kDegree, seed);
    expect_passes_through(Spline::interpolate(poses), poses, 1e-9);
  }
}

TEST(SplineInterpolate, SwingsBackAndForthBy150Degrees) {
  // Between the poses the controls are up to 450 degrees apart here.
  std::vector<StampedPose> poses;
  for (int i = 0; i < 9; ++i) {
    const double angle = i % 2 == 0 ? 0 : 150 * kDegree;
    poses.push_back({0.1 * i, {so3_exp(angle * Vector3d(1, 2, 2) / 3), Vector3d::Zero()}});
  }
  expect_passes_through(Spline::interpolate(poses), poses, 1e-9);
}

TEST(SplineInterpolate, TwoPosesGiveEvenMotion) {
  const Rigid3 a({1, 0, 0, 0}, {1, 2, 3});
  const Rigid3 b(so3_exp({0.3, -0.8, 1.0}), {2, 0, 3});
  const std::vector<StampedPose> poses = {{1, a}, {3, b}};
  const Spline spline = Spline::interpolate(poses);
  expect_passes_through(spline, poses, 1e-12);
  for (const double t : {1.0, 1.3, 2.0, 3.0}) {
    const SplineState state = spline.state(t);
    const Rigid3 expected = interpolate(a, b, (t - 1) / 2);
    EXPECT_LT(angle_between(state.world_from_body.rotation(), expected.rotation()), 1e-12);
    EXPECT_LT((state.velocity_in_world - Vector3d(0.5, -1, 0)).norm(), 1e-12);
    EXPECT_LT((state.angular_velocity_in_body - Vector3d(0.15, -0.4, 0.5)).norm(), 1e-12);
    EXPECT_LT(state.acceleration_in_world.norm() + state.angular_acceleration_in_body.norm(),
              1e-11);
  }
}

TEST(SplineInterpolate, HasNaturalEnds) {
  const auto poses = random_poses(7, 80 * kDegree, 5);
  const Spline spline = Spline::interpolate(poses);
  for (const double t : {spline.start_s(), spline.end_s()}) {
    EXPECT_LT(spline.state(t).acceleration_in_world.norm(), 1e-8);
    EXPECT_LT(spline.state(t).angular_acceleration_in_body.norm(), 1e-8);
  }
}

TEST(SplineInterpolate, IsTwiceContinuousWithExactDerivatives) {
  const auto poses = random_poses(25, 100 * kDegree, 2);
  const Spline spline = Spline::interpolate(poses);
  for (std::size_t i = 1; i + 1 < poses.size(); ++i) {
    expect_twice_continuous(spline, poses[i].t_s);
    expect_derivatives(spline, 0.5 * (poses[i].t_s + poses[i + 1].t_s), 1e-3);
  }
}

TEST(SplineInterpolate, SurvivesKnotsOfVeryDifferentSpacing) {
  std::vector<StampedPose> poses;
  double t = 0;
  for (int i = 0; i < 60; ++i) {
    poses.push_back({t, {so3_exp({std::sin(3 * t), t, 0.2}), {std::sin(2 * t), 4e5 + t * t, 0}}});
    t += i % 20 == 0 ? 0.5 : 0.0005 * (1 + i % 3);
  }
  const Spline spline = Spline::interpolate(poses);
  expect_passes_through(spline, poses, 1e-8);
  for (std::size_t i = 1; i + 1 < poses.size(); ++i) {
    EXPECT_LT(angle_between(spline.pose(poses[i].t_s - 1e-10).rotation(),
                            spline.pose(poses[i].t_s).rotation()),
              1e-8);
  }
}

/// A closed-form motion with its derivatives: a circle of radius 2 at 1.5 rad/s, turning with it
/// about z, on top of a slow swing.
SplineState closed_form(double t) {
  const double w = 1.5;
  SplineState s;
  s.world_from_body = {so3_exp({0, 0, w * t}),
                       {2 * std::cos(w * t), 2 * std::sin(w * t), 0.1 * t * t}};
  s.velocity_in_world = {-2 * w * std::sin(w * t), 2 * w * std::cos(w * t), 0.2 * t};
  s.acceleration_in_world = {-2 * w * w * std::cos(w * t), -2 * w * w * std::sin(w * t), 0.2};
  s.angular_velocity_in_body = {0, 0, w};
  s.angular_acceleration_in_body = Vector3d::Zero();
  return s;
}

std::vector<StampedPose> closed_form_samples(double from_s, double to_s, double step_s) {
  std::vector<StampedPose> poses;
  const auto count = static_cast<int>(std::lround((to_s - from_s) / step_s));
  for (int i = 0; i <= count; ++i) {
    const double t = from_s + i * step_s;
    poses.push_back({t, closed_form(t).world_from_body});
  }
  return poses;
}

TEST(SplineInterpolate, AgreesWithClosedFormMotion) {
  const Spline spline = Spline::interpolate(closed_form_samples(-1, 5, 0.01));
  for (double t = 0; t < 4; t += 0.0137) {
    const SplineState expected = closed_form(t);
    const SplineState actual = spline.state(t);
    EXPECT_LT(
        (actual.world_from_body.translation() - expected.world_from_body.translation()).norm(),
        1e-9);
    EXPECT_LT(angle_between(actual.world_from_body.rotation(), expected.world_from_body.rotation()),
              1e-9);
    EXPECT_LT((actual.velocity_in_world - expected.velocity_in_world).norm(), 1e-6);
    EXPECT_LT((actual.acceleration_in_world - expected.acceleration_in_world).norm(), 1e-3);
    EXPECT_LT((actual.angular_velocity_in_body - expected.angular_velocity_in_body).norm(), 1e-9);
  }
}

TEST(SplineFromControlPoses, MatchesTheDefinition) {
  std::vector<Rigid3> controls;
  for (const StampedPose& p : random_poses(8, 120 * kDegree, 3))
    controls.push_back(p.world_from_camera);
  const Spline spline = Spline::from_control_poses(controls, 2, 0.25);
  EXPECT_EQ(spline.segment_count(), 5u);
  EXPECT_EQ(spline.start_s(), 2);
  EXPECT_EQ(spline.end_s(), 3.25);
  const double u = 0.3;
  const double b[4] = {1, (5 + 3 * u - 3 * u * u + u * u * u) / 6,
                       (1 + 3 * u + 3 * u * u - 2 * u * u * u) / 6, u * u * u / 6};
  Vector3d p = controls[2].translation();
  Eigen::Quaterniond q = controls[2].rotation();
  for (std::size_t j = 1; j < 4; ++j) {
    p += b[j] * (controls[2 + j].translation() - controls[1 + j].translation());
    q = q * so3_exp(b[j] *
                    so3_log(controls[1 + j].rotation().conjugate() * controls[2 + j].rotation()));
  }
  const Rigid3 pose = spline.pose(2 + (2 + u) * 0.25);
  EXPECT_LT((pose.translation() - p).norm(), 1e-14);
  EXPECT_LT(angle_between(pose.rotation(), q), 1e-14);
  for (int i = 1; i < 5; ++i) {
    expect_twice_continuous(spline, 2 + 0.25 * i);
    expect_derivatives(spline, 2 + 0.25 * i - 0.1, 1e-3);
  }
}

TEST(Spline, ClampsTheTimeAndStandsStill) {
  const std::vector<Rigid3> controls(4, Rigid3(so3_exp({1, 2, 3}), {4, 5, 6}));
  const Spline spline = Spline::from_control_poses(controls, 0, 1);
  for (const double t : {-5.0, 0.5, 9.0, std::nan("")}) {
    const SplineState state = spline.state(t);
    EXPECT_LT((state.world_from_body.translation() - Vector3d(4, 5, 6)).norm(), 1e-14);
    EXPECT_LT(angle_between(state.world_from_body.rotation(), controls[0].rotation()), 1e-14);
    EXPECT_LT(state.angular_velocity_in_body.norm(), 1e-15);
  }
}

TEST(Spline, CutIsTheSameMotionFromTimeZero) {
  const auto poses = random_poses(30, 60 * kDegree, 8);
  const Spline whole = Spline::interpolate(poses);
  const double from = poses[4].t_s + 0.01;
  const double duration = poses[20].t_s - from;
  const Spline piece = whole.cut(from, duration);
  EXPECT_EQ(piece.start_s(), 0);
  EXPECT_EQ(piece.end_s(), duration);
  EXPECT_EQ(piece.segment_count(), 16u);
  for (double t = 0; t <= duration; t += 0.0311) {
    EXPECT_LT((piece.pose(t).inverse() * whole.pose(from + t)).log().norm(), 1e-12) << t;
  }
  EXPECT_LT((piece.pose(duration + 1).inverse() * poses[20].world_from_camera).log().norm(), 1e-9);
}

TEST(SplineSmooth, RecoversMotionUnderNoise) {
  auto poses = closed_form_samples(0, 4, 0.005);
  const Random random(4);
  for (std::size_t i = 0; i < poses.size(); ++i) {
    const auto noise = [&](std::uint64_t stream) { return 0.002 * random.normal(stream, i); };
    const Rigid3& p = poses[i].world_from_camera;
    poses[i].world_from_camera = {p.rotation() * so3_exp({noise(0), noise(1), noise(2)}),
                                  p.translation() + Vector3d(noise(3), noise(4), noise(5))};
  }
  const Spline spline = Spline::smooth(poses, 0.2);
  EXPECT_EQ(spline.segment_count(), 20u);
  double sum_position = 0, sum_rotation = 0;
  for (int i = 0; i <= 400; ++i) {
    const Rigid3 truth = closed_form(0.01 * i).world_from_body;
    const SplineState state = spline.state(0.01 * i);
    sum_position += (state.world_from_body.translation() - truth.translation()).squaredNorm();
    sum_rotation += std::pow(angle_between(state.world_from_body.rotation(), truth.rotation()), 2);
    if (i <= 20 || i >= 380) continue;  // the ends have samples on one side only
    EXPECT_LT((state.velocity_in_world - closed_form(0.01 * i).velocity_in_world).norm(), 0.1);
  }
  // 801 samples on 23 controls: noise falls by sqrt(23 / 801) to 0.6 mm and 0.6 mrad over three
  // axes.
  EXPECT_LT(std::sqrt(sum_position / 401), 0.0009);
  EXPECT_LT(std::sqrt(sum_rotation / 401), 0.0009);
}

TEST(SplineSmooth, GoesOnEvenlyThroughGaps) {
  std::vector<StampedPose> poses;
  for (const StampedPose& p : closed_form_samples(0, 4, 0.005)) {
    if (p.t_s < 1.0 || p.t_s > 1.3) poses.push_back(p);
  }
  const Spline spline = Spline::smooth(poses, 0.04);
  for (double t = 0; t < 4; t += 0.01) {
    const bool gap = t > 0.9 && t < 1.4;
    const Rigid3 truth = closed_form(t).world_from_body;
    EXPECT_LT((spline.pose(t).translation() - truth.translation()).norm(), gap ? 0.02 : 1e-4) << t;
    EXPECT_LT(angle_between(spline.pose(t).rotation(), truth.rotation()), gap ? 0.02 : 1e-4) << t;
  }
}

TEST(SplineSmooth, NeedsNoMoreThanTwoPoses) {
  const std::vector<StampedPose> poses = {{0, Rigid3()}, {1, {so3_exp({0, 0, 1}), {1, 0, 0}}}};
  const Spline spline = Spline::smooth(poses, 0.1);
  expect_passes_through(spline, poses, 1e-4);
  EXPECT_LT((spline.pose(0.5).inverse() * Rigid3(so3_exp({0, 0, 0.5}), {0.5, 0, 0})).log().norm(),
            1e-4);
  expect_passes_through(Spline::smooth(poses, 7), poses, 1e-4);
}

TEST(SplineSmooth, FitsRecordedHandHeldMotion) {
  SACCADE_SHARED_DATA_OR_SKIP(path, "trajectories/poster_6dof_handheld.csv");
  const Trajectory recorded = read_csv_trajectory(path);
  std::vector<StampedPose> poses;
  for (const StampedPose& p : recorded.poses()) {
    if (p.t_s <= recorded.start_s() + 20) poses.push_back(p);
  }
  const Spline spline = Spline::smooth(poses, 0.04);
  double squares_m = 0, squares_rad = 0;
  for (const StampedPose& p : poses) {
    const Rigid3 pose = spline.pose(p.t_s);
    squares_m += (pose.translation() - p.world_from_camera.translation()).squaredNorm();
    squares_rad += std::pow(angle_between(pose.rotation(), p.world_from_camera.rotation()), 2);
  }
  const auto count = static_cast<double>(poses.size());
  EXPECT_LT(std::sqrt(squares_m / count), 0.003);
  EXPECT_LT(std::sqrt(squares_rad / count), 0.5 * kDegree);
  double acceleration = 0;
  for (double t = spline.start_s(); t < spline.end_s(); t += 0.005) {
    acceleration = std::max(acceleration, spline.state(t).acceleration_in_world.norm());
  }
  EXPECT_LT(acceleration, 50);
}

TEST(SplineSmooth, ConvergesWithKnotsFarTooCoarseForTheMotion) {
  std::vector<StampedPose> poses;
  for (int i = 0; i < 600; ++i) {
    const double t = 0.005 * i;
    const Vector3d turn(1.2 * std::sin(9 * t), std::cos(13 * t), 0.8 * std::sin(17 * t));
    poses.push_back({t, {so3_exp(turn), turn}});
  }
  for (const double spacing : {0.1, 0.5, 3.0}) {
    const Spline spline = Spline::smooth(poses, spacing);
    EXPECT_LT(spline.state(1.5).angular_velocity_in_body.norm(), 40) << spacing;
  }
}

TEST(SplineSmooth, GivesASplineOfRotationsThatAreNoMotionAtAll) {
  // The path of a method that is lost: rotations that stay, drift, and jump by up to half a turn.
  for (const double rotation_rad : {0.3, 1.0, 2.0, 3.1}) {
    for (std::uint64_t seed = 0; seed < 12; ++seed) {
      const Random random(seed);
      std::vector<StampedPose> poses;
      Eigen::Quaterniond rotation = Eigen::Quaterniond::Identity();
      for (std::uint64_t i = 0; i < 500; ++i) {
        const Vector3d axis =
            Vector3d(random.normal(0, i), random.normal(1, i), random.normal(2, i)).normalized();
        const bool jumps = random.uniform(3, i) < 0.2;
        rotation = rotation * so3_exp((jumps ? rotation_rad : 1e-3) * axis);
        poses.push_back({0.001 * static_cast<double>(i), {rotation, axis}});
      }
      const Spline spline = Spline::smooth(poses, 0.025);
      // No worse than one rotation for all would be, which is far from a fit and still finite.
      double squares = 0, squares_of_one = 0;
      for (const StampedPose& p : poses) {
        const auto error_of = [&](const Eigen::Quaterniond& found) {
          return angle_between(found, p.world_from_camera.rotation());
        };
        squares += std::pow(error_of(spline.pose(p.t_s).rotation()), 2);
        squares_of_one += std::pow(error_of(Eigen::Quaterniond::Identity()), 2);
      }
      EXPECT_LT(squares, squares_of_one) << rotation_rad << " rad, seed " << seed;
    }
  }
}

TEST(SplineAttached, MovesWithTheBodyWithExactDerivatives) {
  const auto poses = random_poses(25, 100 * kDegree, 2);
  const Spline body = Spline::interpolate(poses);
  const Rigid3 body_from_frame(so3_exp({0.4, -1.1, 0.7}), {0.3, -0.2, 0.5});
  const Spline frame = body.attached(body_from_frame);
  EXPECT_EQ(frame.start_s(), body.start_s());
  EXPECT_EQ(frame.end_s(), body.end_s());
  for (std::size_t i = 1; i + 1 < poses.size(); ++i) {
    const double t = 0.5 * (poses[i].t_s + poses[i + 1].t_s);
    const Rigid3 expected = body.pose(t) * body_from_frame;
    EXPECT_LT((expected.inverse() * frame.pose(t)).log().norm(), 1e-14);
    EXPECT_LT((expected.inverse() * frame.state(t).world_from_body).log().norm(), 1e-14);
    expect_twice_continuous(frame, poses[i].t_s);
    expect_derivatives(frame, t, 1e-3);
  }
}

TEST(SplineAttached, ComposesAndSurvivesACut) {
  const Spline body = Spline::interpolate(random_poses(9, 60 * kDegree, 3));
  const Rigid3 a(so3_exp({0.1, 0.2, -0.3}), {0.1, 0, 0.2});
  const Rigid3 b(so3_exp({-0.5, 0.1, 0.9}), {0, 0.4, -0.1});
  const Spline twice = body.attached(a).attached(b).cut(body.start_s() + 0.1, 0.5);
  for (const double t : {0.0, 0.2, 0.5}) {
    const Rigid3 expected = body.pose(body.start_s() + 0.1 + t) * a * b;
    EXPECT_LT((expected.inverse() * twice.pose(t)).log().norm(), 1e-13);
  }
}

TEST(SplineAttached, TheBodysOwnFrameChangesNothing) {
  const Spline body = Spline::interpolate(random_poses(9, 60 * kDegree, 3));
  const SplineState own = body.state(4);
  const SplineState same = body.attached(Rigid3()).state(4);
  EXPECT_EQ(own.velocity_in_world, same.velocity_in_world);
  EXPECT_EQ(own.acceleration_in_world, same.acceleration_in_world);
  EXPECT_EQ(own.angular_velocity_in_body, same.angular_velocity_in_body);
}

}  // namespace
}  // namespace saccade
