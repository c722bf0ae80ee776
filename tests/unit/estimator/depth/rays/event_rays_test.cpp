#include "estimator/depth/rays/event_rays.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/planar_world.h"

namespace saccade {
namespace {

constexpr PinholeCamera kCamera{160, 120, 140, 140, 79.5, 59.5, {}};

Rigid3 motion(double t_s) {
  return {so3_exp({0.3 * t_s, -0.4 * t_s, 0.5 * t_s}), {0.8 * t_s, -0.3 * t_s, 0.4 * t_s}};
}

Trajectory trajectory() { return testing::trajectory_of(motion, 0.2); }

constexpr double kReference_s = 0.1;

/// Events of both polarities all over the sensor and the time.
Events scattered_events() {
  Events events;
  for (int i = 0; i < 400; ++i)
    events.push_back({i * 500'000, static_cast<std::uint16_t>(i * 37 % kCamera.width),
                      static_cast<std::uint16_t>(i * 53 % kCamera.height),
                      static_cast<std::int8_t>(i % 3 == 0 ? -1 : 1)});
  return events;
}

/// Where the pixel's ray at `t_s` meets the depth 1 / rho of the reference view.
Eigen::Vector2d seen(const Eigen::Vector2d& pixel, double t_s, double rho) {
  const Rigid3 reference_from_camera = motion(kReference_s).inverse() * *trajectory().at(t_s);
  const Eigen::Vector3d direction = reference_from_camera.rotation() * kCamera.ray(pixel);
  const Eigen::Vector3d& centre = reference_from_camera.translation();
  return kCamera.project(centre + (1 / rho - centre.z()) / direction.z() * direction);
}

/// The ray of an event, found by its derotated pixel.
std::size_t index_of(const EventRays& rays, const Event& event) {
  const Eigen::Vector2d far = seen({event.x, event.y}, seconds_from_ns(event.t_ns), 1e-12);
  for (std::size_t i = 0; i < rays.size(); ++i)
    if (std::hypot(rays.line[i].ax - far.x(), rays.line[i].ay - far.y()) < 1e-3) return i;
  return rays.size();
}

class EventRaysTest : public ::testing::Test {
 protected:
  Trajectory trajectory_ = trajectory();
  Events events_ = scattered_events();
  UndistortionTable undistortion_{kCamera};
  EventRays rays_{{events_, &trajectory_, kReference_s}, kCamera, undistortion_, 8};
};

TEST_F(EventRaysTest, ARayIsALineInInverseDepth) {
  ASSERT_EQ(rays_.size(), events_.size());
  for (const Event& event : events_) {
    const std::size_t i = index_of(rays_, event);
    ASSERT_LT(i, rays_.size());
    for (const double rho : {0.1, 0.5, 2.0}) {
      const Eigen::Vector2d x = seen({event.x, event.y}, seconds_from_ns(event.t_ns), rho);
      EXPECT_NEAR(rays_.line[i].ax + static_cast<float>(rho) * rays_.line[i].bx, x.x(), 2e-3);
      EXPECT_NEAR(rays_.line[i].ay + static_cast<float>(rho) * rays_.line[i].by, x.y(), 2e-3);
    }
  }
}

TEST_F(EventRaysTest, TheRiseIsTheMotionOfTheFootprintTimesPolarity) {
  constexpr double kStep_s = 1e-3, kRho = 0.7;
  for (const Event& event : events_) {
    const double t_s = seconds_from_ns(event.t_ns);
    if (t_s < 2 * kStep_s || t_s > 0.2 - 2 * kStep_s) continue;
    const Eigen::Vector2d pixel(event.x, event.y);
    const Eigen::Vector2d gradient =
        event.polarity * (seen(pixel, t_s + kStep_s, kRho) - seen(pixel, t_s - kStep_s, kRho)) /
        (2 * kStep_s);
    const RayGradient& q = rays_.gradient[index_of(rays_, event)];
    EXPECT_NEAR(static_cast<double>(q.qax) + kRho * static_cast<double>(q.qbx), gradient.x(),
                0.02 * gradient.norm());
    EXPECT_NEAR(static_cast<double>(q.qay) + kRho * static_cast<double>(q.qby), gradient.y(),
                0.02 * gradient.norm());
  }
}

TEST_F(EventRaysTest, ADelayIsTakenOutAsIfItHadBeenKnown) {
  ViewWindow delayed{events_, &trajectory_, kReference_s};
  delayed.event_delay_s = 1e-3;
  const EventRays known(delayed, kCamera, undistortion_, 8);
  EventRays taken_out = rays_;
  taken_out.take_out(1e-3, delayed, kCamera);
  double moved_px = 0;
  for (std::size_t i = 0; i < known.size(); ++i) {
    // Before the first pose there is none.
    if (events_[known.source[i]].t_ns < 1'000'000) continue;
    EXPECT_NEAR(taken_out.line[i].ax, known.line[i].ax, 2e-3);
    EXPECT_NEAR(taken_out.line[i].by, known.line[i].by, 2e-3);
    moved_px =
        std::max(moved_px, std::abs(static_cast<double>(known.line[i].ax - rays_.line[i].ax)));
  }
  EXPECT_GT(moved_px, 0.05);
  for (int k = 0; k < 8; ++k)
    EXPECT_TRUE(taken_out.slices()[static_cast<std::size_t>(k)].centre.isApprox(
        known.slices()[static_cast<std::size_t>(k)].centre));
}

TEST_F(EventRaysTest, EveryEventIsInTheCellWhereItsPointIsSeen) {
  std::size_t found = 0;
  for (const Event& event : events_) {
    const std::size_t i = index_of(rays_, event);
    const int slice = std::min(7, static_cast<int>(event.t_ns * 8 / events_.back().t_ns));
    const int column = rays_.column_of(event.x), row = rays_.row_of(event.y);
    const bool is_on = event.polarity > 0;
    if (i >= rays_.cell_begin(slice, is_on, column, row) &&
        i < rays_.cell_begin(slice, is_on, column + 1, row))
      ++found;
  }
  // Events on the border of two slices may belong to either.
  EXPECT_GE(found, events_.size() - 8);
}

TEST_F(EventRaysTest, ASlabSeesAPointWhereTheCameraDoes) {
  for (const EventRays::TimeSlice& slice : rays_.slices()) {
    const Rigid3 camera_from_reference =
        trajectory_.at_clamped(kReference_s + static_cast<double>(slice.middle_s)).inverse() *
        motion(kReference_s);
    const Eigen::Vector2d pixel(30, 70);
    const Eigen::Vector2d truth =
        kCamera.project(camera_from_reference * (kCamera.ray(pixel) / 0.5));
    const Eigen::Vector2f at = slice.project(pixel.cast<float>(), 0.5F).hnormalized();
    EXPECT_NEAR(at.x(), truth.x(), 1e-2);
    EXPECT_NEAR(at.y(), truth.y(), 1e-2);
  }
}

}  // namespace
}  // namespace saccade
