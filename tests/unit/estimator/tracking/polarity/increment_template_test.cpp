#include "estimator/tracking/polarity/increment_template.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/camera.h"
#include "tests/support/jacobian_check.h"
#include "tests/unit/estimator/uneven_camera.h"

namespace saccade {
namespace {

using testing::central_differences;
using testing::small_uneven_camera;
using Vector6 = Eigen::Matrix<double, 6, 1>;

constexpr double kWavyDepth_m = 2;

/// A wall whose log intensity is a gentle function of the pixel that sees it from the origin.
double wall(const Eigen::Vector2d& pixel) {
  return 0.3 * std::sin(0.11 * pixel.x() + 0.05 * pixel.y()) +
         0.4 * std::cos(0.08 * pixel.y() - 0.03 * pixel.x());
}

double depth_at(const Eigen::Vector2d&) { return kWavyDepth_m; }

/// What a camera that has moved by `camera_from_wall` sees at a pixel.
double seen(const Eigen::Vector2d& pixel, const Rigid3& map_from_camera) {
  const Eigen::Vector3d ray = map_from_camera.rotation_matrix() * small_uneven_camera().ray(pixel);
  const double scale = (kWavyDepth_m - map_from_camera.translation().z()) / ray.z();
  return wall(small_uneven_camera().project(map_from_camera.translation() + scale * ray));
}

class WavyWall {
 public:
  WavyWall() : reference_(reference()), map_(small_uneven_camera(), std::span(&reference_, 1), 0) {}
  [[nodiscard]] const IntensityMap& map() const { return map_; }

 private:
  static ReferenceView reference() {
    ReferenceView view{ImageF(64, 48), ImageF(64, 48), Rigid3()};
    for (int y = 0; y < 48; ++y)
      for (int x = 0; x < 64; ++x) {
        view.log_intensity(x, y) = static_cast<float>(wall({x, y}));
        // A hole in the map.
        const bool is_known = x < 20 || x > 23 || y < 20 || y > 23;
        view.depth(x, y) = is_known ? static_cast<float>(depth_at({x, y})) : 0;
      }
    return view;
  }
  ReferenceView reference_;
  IntensityMap map_;
};

IncrementTemplate template_of(const WavyWall& scene) {
  MapView view(scene.map(), 0);
  view.draw(Rigid3());
  IncrementTemplate increments(small_uneven_camera());
  increments.draw(view, scene.map().atlas());
  return increments;
}

Twist some_velocity() {
  Twist velocity;
  velocity << 0.3, -0.2, 0.25, 0.1, 0.15, -0.3;
  return velocity;
}

Eigen::Vector2d pixel_of(const IncrementPoints& points, std::size_t i) {
  const PinholeCamera camera = small_uneven_camera();
  return {camera.fx * static_cast<double>(points.ray_x[i]) + camera.cx,
          camera.fy * static_cast<double>(points.ray_y[i]) + camera.cy};
}

/// How fast the brightness of a pixel changes while the camera moves.
double true_increment_at(const Eigen::Vector2d& pixel) {
  constexpr double kStep_s = 1e-4;
  return (seen(pixel, Rigid3::exp(kStep_s * some_velocity())) -
          seen(pixel, Rigid3::exp(-kStep_s * some_velocity()))) /
         (2 * kStep_s);
}

TEST(IncrementTemplate, IncrementsAreWhatAMovingCameraSees) {
  const WavyWall scene;
  IncrementTemplate increments = template_of(scene);
  const IncrementPoints& points = increments.points(some_velocity(), 0);
  ASSERT_GT(points.count, 2000U);
  double largest = 0;
  for (std::size_t i = 0; i < points.count; ++i) {
    const double expected = true_increment_at(pixel_of(points, i));
    largest = std::max(largest, std::abs(expected));
    EXPECT_NEAR(points.increment[i], expected, 0.02) << pixel_of(points, i).transpose();
    EXPECT_NEAR(points.inverse_depth[i], 0.5, 1e-5);
  }
  EXPECT_GT(largest, 0.5) << "the test needs a signal";
}

TEST(IncrementTemplate, JacobianIsThatOfTheIncrementsWithThePointsMotion) {
  // Against differences of the exact increments, which the template reads off neighbouring pixels.
  const WavyWall scene;
  IncrementTemplate increments = template_of(scene);
  const IncrementPoints& points = increments.points(some_velocity(), 0);
  for (std::size_t i = 0; i < points.count; i += 97) {
    const Eigen::Vector2d pixel = pixel_of(points, i);
    const Eigen::Vector3d point = kWavyDepth_m * small_uneven_camera().ray(pixel);
    const auto moved = [&](const Vector6& twist) {
      return Eigen::Matrix<double, 1, 1>(
          true_increment_at(small_uneven_camera().project(Rigid3::exp(twist) * point)));
    };
    const Vector6 numeric =
        central_differences<1, 6>(moved, Vector6(Vector6::Zero()), 1e-3).transpose();
    Vector6 row;
    for (std::size_t c = 0; c < 6; ++c)
      row(static_cast<Eigen::Index>(c)) = static_cast<double>(points.by_pose[c][i]);
    EXPECT_LT((row - numeric).cwiseAbs().maxCoeff(), 0.05 * std::max(1.0, numeric.norm()))
        << row.transpose() << "\nnumeric " << numeric.transpose();
    const double slope = Eigen::Vector2d((true_increment_at(pixel + Eigen::Vector2d(0.5, 0)) -
                                          true_increment_at(pixel - Eigen::Vector2d(0.5, 0))),
                                         (true_increment_at(pixel + Eigen::Vector2d(0, 0.5)) -
                                          true_increment_at(pixel - Eigen::Vector2d(0, 0.5))))
                             .norm();
    EXPECT_NEAR(points.slope[i], slope, 0.01);
  }
}

TEST(IncrementTemplate, NothingIsExpectedNextToTheUnknown) {
  const WavyWall scene;
  IncrementTemplate increments = template_of(scene);
  const IncrementPoints& points = increments.points(some_velocity(), 0);
  for (std::size_t i = 0; i < points.count; ++i) {
    const Eigen::Vector2d pixel = pixel_of(points, i);
    EXPECT_FALSE(pixel.x() > 17.5 && pixel.x() < 25.5 && pixel.y() > 19.5 && pixel.y() < 23.5);
    EXPECT_GT(pixel.x(), 1.5);
    EXPECT_LT(pixel.y(), 45.5);
  }
}

TEST(IncrementTemplate, KeepsTheSteepOnes) {
  const WavyWall scene;
  IncrementTemplate increments = template_of(scene);
  const std::size_t all = increments.points(some_velocity(), 0).count;
  const IncrementPoints& steep = increments.points(some_velocity(), 1);
  EXPECT_LT(steep.count, 0.7 * static_cast<double>(all));
  EXPECT_GT(steep.count, 0.2 * static_cast<double>(all));
  const float least = *std::min_element(
      steep.slope.begin(), steep.slope.begin() + static_cast<std::ptrdiff_t>(steep.count));
  const std::size_t doubled = increments.points(2 * some_velocity(), 1).count;
  EXPECT_EQ(doubled, steep.count) << "whatever the speed";
  EXPECT_GT(least, 0);
}

}  // namespace
}  // namespace saccade
