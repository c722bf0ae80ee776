#include "estimator/edges/edge_residual.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/jacobian_check.h"
#include "tests/unit/estimator/uneven_camera.h"

namespace saccade {
namespace {

using testing::uneven_camera;

EdgeObservation some_observation() {
  EdgeObservation o;
  o.view_from_camera = Rigid3::exp((Twist() << 0.1, -0.05, 0.02, 0.03, -0.02, 0.05).finished());
  o.ray = {0.21, -0.13, 1};
  o.lag = -1;
  o.pixel = {165, 62};
  o.normal = Eigen::Vector2d(0.8, 0.6);
  return o;
}

TEST(EdgeResidual, IsTheDistanceOfThePointOnTheRayFromTheEdge) {
  const PinholeCamera camera = uneven_camera();
  EdgeObservation o = some_observation();
  // A point on the ray, wherever: its projection into the view is x(rho).
  const Eigen::Vector3d point = o.view_from_camera * (2.3 * o.ray);
  const Eigen::Vector2d seen = camera.project(point);
  o.pixel = seen + 0.7 * o.normal + 1.5 * Eigen::Vector2d(-o.normal.y(), o.normal.x());
  const double residual =
      edge_residual(o, camera, Twist::Zero(), {1 / point.z(), 0.1, 0.2, 0.3}, nullptr);
  // The same pixel of the sensor is larger in the view by the ratio of the depths.
  EXPECT_NEAR(residual, (-0.7 - 0.1 - 0.2 * -1.5 - 0.3 * -1) * point.z() / 2.3, 1e-9);
}

TEST(EdgeResidual, HasItsDerivativesAlsoAwayFromZero) {
  const PinholeCamera camera = uneven_camera();
  const EdgeObservation o = some_observation();
  const Twist motion = (Twist() << 0.02, -0.01, 0.03, 0.01, 0.02, -0.015).finished();
  const EdgeUnknowns edge(0.4, 0.1, 0.05, 0.2);
  EdgeDerivatives derivatives;
  (void)edge_residual(o, camera, motion, edge, &derivatives);
  testing::expect_jacobian<1, 6>(
      derivatives.motion,
      [&](const Twist& m) {
        return Eigen::Matrix<double, 1, 1>(edge_residual(o, camera, m, edge, nullptr));
      },
      motion);
  testing::expect_jacobian<1, 4>(
      derivatives.edge,
      [&](const EdgeUnknowns& e) {
        return Eigen::Matrix<double, 1, 1>(edge_residual(o, camera, motion, e, nullptr));
      },
      edge);
}

TEST(EdgeResidual, ARayThatLeadsAwayFromTheViewIsNoResidual) {
  EdgeObservation o = some_observation();
  o.view_from_camera = {so3_exp({0, 3, 0}), Eigen::Vector3d::Zero()};
  EXPECT_TRUE(
      std::isnan(edge_residual(o, uneven_camera(), Twist::Zero(), {0.4, 0, 0, 0}, nullptr)));
}

}  // namespace
}  // namespace saccade
