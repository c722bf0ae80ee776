#include "estimator/depth/thesis/derotated_frame.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

namespace saccade {
namespace {

PinholeCamera lens_camera(double k1 = 0) {
  PinholeCamera camera;
  camera.width = 120;
  camera.height = 90;
  camera.fx = camera.fy = 100;
  camera.cx = 59.5;
  camera.cy = 44.5;
  camera.distortion[0] = k1;
  return camera;
}

/// Turns at 3 rad/s about a tilted axis, and moves, which must not matter.
Trajectory turning() {
  std::vector<StampedPose> poses;
  for (int i = 0; i <= 100; ++i) {
    const double t_s = i * 1e-3;
    poses.push_back({t_s, {so3_exp(t_s * Eigen::Vector3d(1, -2, 2)), {t_s, 2 * t_s, -t_s}}});
  }
  return Trajectory(poses);
}

float sum(const ImageF& image) {
  return std::accumulate(image.pixels().begin(), image.pixels().end(), 0.F);
}

Eigen::Vector2d centre_of_mass(const ImageF& image) {
  Eigen::Vector2d centre(0, 0);
  for (int y = 0; y < image.height(); ++y)
    for (int x = 0; x < image.width(); ++x)
      centre += static_cast<double>(image(x, y)) * Eigen::Vector2d(x, y);
  return centre / static_cast<double>(sum(image));
}

TEST(Derotation, HoldsADirectionStill) {
  for (const double k1 : {0.0, -0.2}) {
    const PinholeCamera sensor = lens_camera(k1);
    const UndistortionTable undistortion(sensor);
    const Trajectory trajectory = turning();
    const Rigid3 reference = trajectory.at_clamped(0.05);
    const Derotation derotation(sensor.undistorted(), undistortion, trajectory,
                                reference.rotation());
    const Eigen::Vector3d direction = reference.rotation() * sensor.ray({66.3, 40.8});
    Events events;
    Eigen::Vector2d rounding(0, 0);
    for (int i = 0; i <= 1000; ++i) {
      const double t_s = i * 1e-4;
      const Eigen::Vector3d ray = trajectory.at_clamped(t_s).rotation().conjugate() * direction;
      const Eigen::Vector2d seen = sensor.distort(sensor.project(ray));
      events.push_back({ns_from_seconds(t_s), static_cast<std::uint16_t>(std::lround(seen.x())),
                        static_cast<std::uint16_t>(std::lround(seen.y())),
                        static_cast<std::int8_t>(i % 2 == 0 ? 1 : -1)});
    }
    const ImageF frame = derotation.draw(events);
    EXPECT_NEAR(sum(frame), 1001, 0.1) << "signs do not count";
    EXPECT_LT((centre_of_mass(frame) - Eigen::Vector2d(66.3, 40.8)).norm(), 0.1)
        << "pixels of the sensor round, on average away";
    // Raw, they would spread over some 30 px; rounding alone leaves 0.3 px on either axis.
    for (int y = 0; y < frame.height(); ++y)
      for (int x = 0; x < frame.width(); ++x)
        EXPECT_TRUE(std::hypot(x - 66.3, y - 40.8) < 3 || frame(x, y) == 0) << x << ' ' << y;
  }
}

TEST(Derotation, LeavesOutWhatLeavesTheView) {
  const PinholeCamera sensor = lens_camera();
  const UndistortionTable undistortion(sensor);
  const Trajectory trajectory = turning();
  const Derotation derotation(sensor, undistortion, trajectory, so3_exp({0, 3, 0}));
  EXPECT_EQ(sum(derotation.draw(Events{{0, 60, 40, 1}})), 0) << "the reference looks backwards";
  EXPECT_EQ(sum(derotation.draw({})), 0);
}

TEST(NormaliseFrame, TakesTheLogarithmAndScales) {
  ImageF frame(4, 2);
  frame(1, 0) = 1;
  frame(2, 1) = 3;
  normalise_frame(frame);
  EXPECT_NEAR(frame(2, 1) / frame(1, 0), 2, 1e-6) << "log 4 / log 2";
  double squares = 0;
  for (const float value : frame.pixels()) squares += static_cast<double>(value) * value;
  EXPECT_NEAR(squares / 8, 1, 1e-6);
}

TEST(NormaliseFrame, AnEmptyFrameStaysZero) {
  ImageF frame(8, 8);
  normalise_frame(frame);
  EXPECT_EQ(frame, ImageF(8, 8));
}

}  // namespace
}  // namespace saccade
