#include "estimator/tracking/image_motion.h"

#include <gtest/gtest.h>

#include "tests/unit/estimator/uneven_camera.h"

namespace saccade {
namespace {

using testing::uneven_camera;

TEST(ImageMotion, IsTheDerivativeOfTheReprojection) {
  Twist velocity;
  velocity << 0.8, -0.5, 0.6, 0.3, -0.4, 0.9;
  const PinholeCamera camera = uneven_camera();
  const ImageMotion motion(camera, velocity);
  constexpr double kStep_s = 1e-5;
  for (const Eigen::Vector2d& pixel : {Eigen::Vector2d(40, 70), Eigen::Vector2d(100, 20)})
    for (const double depth : {0.5, 2.0, 5.0}) {
      const auto at = [&](double t_s) {
        const Rigid3 start_from_camera = Rigid3::exp(velocity * t_s);
        return camera.project(start_from_camera.inverse() * (depth * camera.ray(pixel)));
      };
      const Eigen::Vector2d slope = (at(kStep_s) - at(-kStep_s)) / (2 * kStep_s);
      EXPECT_GT(slope.norm(), 20) << "the test must move";
      const Eigen::Vector2f found = motion(pixel.cast<float>(), static_cast<float>(1 / depth));
      EXPECT_LT((found.cast<double>() - slope).norm(), 1e-3 * slope.norm());
    }
}

}  // namespace
}  // namespace saccade
