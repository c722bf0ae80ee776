#include "estimator/edges/window/image_motion.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/unit/estimator/uneven_camera.h"

namespace saccade {
namespace {

using testing::uneven_camera;

/// A step to the side that a turn makes up for is hardly told; either alone is, to the pixel.
TEST(ImageMotion, TellsMotionsThatLookAlikeApartByLittle) {
  const PinholeCamera camera = uneven_camera();
  const double depth_m = 2;
  const Matrix6 root = image_motion_sqrt_information(camera, depth_m, 1);
  const double pixel_m = depth_m / camera.fx;
  const Twist aside = (Twist() << pixel_m, 0, 0, 0, 0, 0).finished();
  const Twist turn = (Twist() << 0, 0, 0, 0, 1 / camera.fx, 0).finished();
  EXPECT_NEAR((root * turn).norm(), 1, 0.2);
  EXPECT_NEAR((root * aside).norm(), std::sqrt((4 + 1 + 0.25) / 3), 1e-9);
  EXPECT_LT((root * (turn - aside)).norm(), (root * (turn + aside)).norm() / 2);
}

}  // namespace
}  // namespace saccade
