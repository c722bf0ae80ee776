#include "estimator/refinement/poses/plane_reprojection.h"

#include <gtest/gtest.h>

#include "tests/support/jacobian_check.h"
#include "tests/unit/estimator/uneven_camera.h"

namespace saccade {
namespace {

using testing::uneven_camera;

const Rigid3 kViewFromCamera =
    Rigid3::exp((Twist() << 0.1, -0.05, 0.02, 0.03, -0.02, 0.05).finished());
const Eigen::Vector3d kRay(0.21, -0.13, 1);
const ViewPlane kPlane(0.05, -0.1, 0.4);

TEST(PlaneReprojection, IsTheProjectionOfAPointOnThePlane) {
  const PlaneReprojection place =
      reproject_on_plane(uneven_camera(), kViewFromCamera, kRay, kPlane);
  ASSERT_TRUE(place.is_valid);
  const double inverse_depth = kPlane.dot(uneven_camera().ray(place.pixel));
  const Eigen::Vector3d point = uneven_camera().ray(place.pixel) / inverse_depth;
  const Eigen::Vector3d in_camera = kViewFromCamera.inverse() * point;
  EXPECT_LT((in_camera / in_camera.z() - kRay).norm(), 1e-12);
}

TEST(PlaneReprojection, HasItsDerivative) {
  const PlaneReprojection place =
      reproject_on_plane(uneven_camera(), kViewFromCamera, kRay, kPlane);
  testing::expect_jacobian<2, 6>(
      place.by_motion,
      [&](const Twist& change) {
        const Rigid3 moved(kViewFromCamera.rotation() * so3_exp(change.tail<3>()),
                           kViewFromCamera.translation() + change.head<3>());
        return reproject_on_plane(uneven_camera(), moved, kRay, kPlane).pixel;
      },
      Twist::Zero(), 1e-6);
}

TEST(PlaneReprojection, APlaneBehindTheCameraIsNotSeen) {
  EXPECT_FALSE(reproject_on_plane(uneven_camera(), kViewFromCamera, kRay, -kPlane).is_valid);
  EXPECT_FALSE(reproject_on_plane(uneven_camera(), {}, {0, 0, 1}, {1, 0, 0}).is_valid);
}

}  // namespace
}  // namespace saccade
