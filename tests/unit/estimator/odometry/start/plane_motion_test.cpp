#include "estimator/odometry/start/plane_motion.h"

#include <gtest/gtest.h>

namespace saccade {
namespace {

const PlaneMotion kMotion{{0.4, -0.3, 0.5}, {0.2, 0.5, -0.3}, {0.3, -0.2}};

/// Where the plane's point on a ray of the camera at time 0 is seen at another.
Eigen::Vector2d seen(const PlaneMotion& motion, const Eigen::Vector3d& ray, double t_s) {
  const Eigen::Vector3d point = ray / motion.plane().dot(ray);
  return (motion.reference_from_camera(t_s).inverse() * point).hnormalized();
}

TEST(PlaneMotion, IsTheSameSeenFromAnotherTime) {
  const PlaneMotion later = kMotion.seen_at(0.2);
  const Eigen::Vector3d ray(0.3, 0.2, 1);
  // The plane's point on that ray of the later camera, by the earlier one's.
  const Eigen::Vector3d point = kMotion.reference_from_camera(0.2) * (ray / later.plane().dot(ray));
  const double depth =
      (1 - kMotion.plane().dot(kMotion.reference_from_camera(0.2).translation())) /
      kMotion.plane().dot(kMotion.reference_from_camera(0.2).rotation() * Eigen::Vector3d::UnitZ());
  const Eigen::Vector3d metric =
      kMotion.reference_from_camera(0.2) * (depth * ray / later.plane().dot(ray));
  EXPECT_NEAR(kMotion.plane().dot(metric), 1, 1e-12);
  EXPECT_NE(point, metric) << "the unit of length is another";
  EXPECT_LT((later.velocity * depth -
             kMotion.reference_from_camera(0.2).rotation().inverse() * kMotion.velocity)
                .norm(),
            1e-12);
}

TEST(PlaneMotion, StepAndTurnShareTheMotionInTheViewingDirection) {
  constexpr double kStep_s = 1e-5;
  const Eigen::Vector3d ray(0, 0, 1);
  const Eigen::Vector2d moved = seen(kMotion, ray, kStep_s);
  for (const double share : {0.0, 0.5, 1.5}) {
    const PlaneMotion other = kMotion.with_translation_fraction(share);
    EXPECT_LT((seen(other, ray, kStep_s) - moved).norm(), 1e-3 * moved.norm()) << share;
  }
  EXPECT_LT(kMotion.with_translation_fraction(1).rate.head<2>().norm(), 1e-15);
  EXPECT_LT(kMotion.with_translation_fraction(0).velocity.head<2>().norm(), 1e-15);
}

}  // namespace
}  // namespace saccade
