#include "estimator/mosaic/mosaic.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <string_view>
#include <vector>

#include "tests/support/direction_world.h"

namespace saccade {
namespace {

using testing::DirectionWorld;
using testing::small_camera;
using testing::sweep;

constexpr double kContrast = 0.1;

struct Found {
  Panorama panorama;
  Reconstruction mosaic;

  [[nodiscard]] double correlation() const {
    return testing::correlation(mosaic.log_image, DirectionWorld::log_intensity(panorama),
                                mosaic.observed);
  }
  [[nodiscard]] double observed() const {
    const auto marked =
        std::count(mosaic.observed.pixels().begin(), mosaic.observed.pixels().end(), 1);
    return static_cast<double>(marked) / static_cast<double>(mosaic.observed.size());
  }
};

MosaicOptions options_of(std::string_view method) {
  MosaicOptions options;
  options.method = method;
  options.observations().event_sigma = 0.05;
  options.observations().no_event_spacing_px = 1;
  return options;
}

Trajectory poses_of(const testing::OrientationFunction& turning, double end_s) {
  std::vector<StampedPose> poses;
  for (int i = 0; i <= static_cast<int>(1000 * end_s); ++i)
    poses.push_back({1e-3 * i, {turning(1e-3 * i), Eigen::Vector3d::Zero()}});
  return Trajectory(std::move(poses));
}

Found find(std::string_view method, const testing::OrientationFunction& turning, double end_s) {
  const DirectionWorld world(small_camera());
  const Events events = world.simulate(turning, end_s, kContrast);
  const Trajectory poses = poses_of(turning, end_s);
  std::vector<Eigen::Matrix3d> orientations;
  for (const StampedPose& pose : poses.poses())
    orientations.push_back(pose.world_from_camera.rotation_matrix());
  Found found;
  found.panorama = panorama_around(FieldOfView(small_camera()), orientations, small_camera().fx);
  found.mosaic = make_mosaic({small_camera(), events, poses, {kContrast, kContrast}},
                             found.panorama, options_of(method));
  return found;
}

TEST(Mosaic, EquationsRecoverASweepWiderThanTheCamera) {
  const Found found = find(MosaicOptions::kEquations, sweep(0, 1.5), 1.0);
  EXPECT_GT(found.correlation(), 0.97);
  EXPECT_GT(found.observed(), 0.5);
  EXPECT_GT(found.panorama.width, 2 * small_camera().width);
}

TEST(Mosaic, TheGradientFilterRecoversItNotItsNegative) {
  EXPECT_GT(find(MosaicOptions::kGradient, sweep(0, 1.5), 1.0).correlation(), 0.9);
}

/// The picture's seam is nothing to the world: a sweep across it is as good as one elsewhere, and
/// one all around closes.
class MosaicSeam : public ::testing::TestWithParam<std::string_view> {};

TEST_P(MosaicSeam, ASweepAcrossItIsNoWorse) {
  EXPECT_GT(find(GetParam(), sweep(2.7, 1.5), 1.0).correlation(), 0.9);
}

TEST_P(MosaicSeam, AWholeTurnClosesThere) {
  const Found found = find(GetParam(), sweep(1.0, 6), 1.5);
  ASSERT_TRUE(found.panorama.wraps());
  EXPECT_GT(found.correlation(), 0.9);
  // The step from a column to the next is no worse at the seam than elsewhere.
  const ImageF& image = found.mosaic.log_image;
  const ImageF truth = DirectionWorld::log_intensity(found.panorama);
  const auto step_error = [&](int from, int to) {
    double sum = 0;
    for (int y = image.height() / 4; y < image.height() * 3 / 4; ++y)
      sum += std::abs(
          static_cast<double>(image(to, y) - image(from, y) - (truth(to, y) - truth(from, y))));
    return sum;
  };
  double sum = 0;
  for (int x = 1; x < image.width(); ++x) sum += step_error(x - 1, x);
  EXPECT_LT(step_error(image.width() - 1, 0), 2 * sum / (image.width() - 1));
}

INSTANTIATE_TEST_SUITE_P(Methods, MosaicSeam,
                         ::testing::Values(MosaicOptions::kGradient, MosaicOptions::kEquations),
                         [](const auto& tested) {
                           return std::string(
                               tested.param == MosaicOptions::kGradient ? "Gradient" : "Equations");
                         });

/// A camera that turns over the zenith sees every longitude at once.
TEST(Mosaic, APoleIsNoWorseThanOtherDirections) {
  const testing::OrientationFunction over_the_top = [](double t_s) {
    return Eigen::Quaterniond(Eigen::AngleAxisd(-1.0 - 1.2 * t_s, Eigen::Vector3d::UnitY()) *
                              Eigen::AngleAxisd(0.3 * t_s, Eigen::Vector3d::UnitX())) *
           sweep(0, 0)(0);
  };
  const Found found = find(MosaicOptions::kEquations, over_the_top, 1.0);
  EXPECT_TRUE(found.panorama.wraps());
  EXPECT_EQ(found.panorama.top, 0);
  EXPECT_GT(found.correlation(), 0.9);
}

TEST(Mosaic, OfNoEventsIsFlat) {
  const Trajectory poses = poses_of(sweep(0, 1), 0.1);
  const Events events = {{1000, 3, 3, 1}};
  const Reconstruction mosaic =
      make_mosaic({small_camera(), events, poses, {0.2, 0.2}}, Panorama::sphere(pixels_around(20)),
                  options_of(MosaicOptions::kEquations));
  for (const float value : mosaic.log_image.pixels()) EXPECT_NEAR(value, 0, 0.1);
}

}  // namespace
}  // namespace saccade
