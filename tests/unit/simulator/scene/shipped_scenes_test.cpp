#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <limits>
#include <string>

#include "core/config/config.h"
#include "simulator/motion/motion.h"
#include "simulator/scene/build_scene.h"
#include "simulator/simulation_config.h"

namespace saccade {
namespace {

constexpr std::size_t kColumns = 16;
constexpr int kRows = 32;

/// What a camera sees of a scene at a coarse grid of pixels and a few times.
struct Survey {
  double nearest_m = std::numeric_limits<double>::infinity();  ///< z depth
  double farthest_m = 0;
  double mean_m = 0;
  double covered = 0;           ///< fraction of the rays that hit something
  double log_radiance_rms = 0;  ///< deviation from the mean
};

/// A row of 16 pixels across the whole width.
std::array<Shade, kColumns> look(const Scene& scene, const PinholeCamera& camera,
                                 const Rigid3& pose, double y) {
  std::array<Ray, kColumns> rays;
  std::array<TriangleId, kColumns> triangles;
  for (std::size_t i = 0; i < kColumns; ++i) {
    const double x = (static_cast<double>(i) + 0.5) * camera.width / kColumns;
    rays[i] = {pose.translation(), pose.rotation() * camera.ray({x, y})};
  }
  scene.visible(rays, triangles);
  std::array<Shade, kColumns> seen;
  for (std::size_t i = 0; i < kColumns; ++i) seen[i] = scene.shade(rays[i], triangles[i]);
  return seen;
}

Survey survey(const SimulationConfig& config) {
  SceneOptions options = config.scene;
  options.lighting = Lighting::kNone;
  const Scene scene = build_scene(options);
  const Spline motion = build_motion(config.trajectory);
  Survey result;
  double rays = 0, hits = 0, sum = 0, squares = 0;
  for (const double share : {0.0, 0.5, 1.0}) {
    const Rigid3 pose = motion.pose(std::lerp(motion.start_s(), motion.end_s(), share));
    for (int row = 0; row < kRows; ++row) {
      const double y = (row + 0.5) * config.camera.height / kRows;
      for (const Shade& shade : look(scene, config.camera, pose, y)) {
        const double log_radiance = std::log(0.001 + shade.radiance);
        ++rays;
        sum += log_radiance;
        squares += log_radiance * log_radiance;
        if (shade.distance == 0) continue;
        ++hits;
        result.nearest_m = std::min(result.nearest_m, shade.distance);
        result.farthest_m = std::max(result.farthest_m, shade.distance);
        result.mean_m += shade.distance;
      }
    }
  }
  result.mean_m /= hits;
  result.covered = hits / rays;
  result.log_radiance_rms = std::sqrt(squares / rays - std::pow(sum / rays, 2));
  return result;
}

struct Expected {
  std::string name;
  double nearest_m, farthest_m, mean_m;
};

class ShippedScene : public ::testing::TestWithParam<Expected> {};

TEST_P(ShippedScene, FillsThePictureWithTextureAtTheStatedDepth) {
  const Expected& expected = GetParam();
  if (expected.name == "desk" && !std::filesystem::exists("/usr/share/sweethome3d/furniture"))
    GTEST_SKIP() << "the furniture is missing: apt-get install sweethome3d-furniture";
  const Survey seen = survey(config::read<SimulationConfig>(
      config::load("configs/simulation/" + expected.name + ".yaml")));
  EXPECT_EQ(seen.covered, 1);
  EXPECT_GT(seen.nearest_m, expected.nearest_m);
  EXPECT_LT(seen.farthest_m, expected.farthest_m);
  EXPECT_NEAR(seen.mean_m, expected.mean_m, 0.1 * expected.mean_m);
  EXPECT_GT(seen.log_radiance_rms, 0.25);
}

INSTANTIATE_TEST_SUITE_P(
    All, ShippedScene,
    ::testing::Values(Expected{"walls", 3, 12, 6.6}, Expected{"walls_640x480", 3, 12, 6.6},
                      Expected{"walls_1280x720", 3, 12, 6.6}, Expected{"planes", 1, 4, 2.3},
                      Expected{"dunes", 1.5, 6, 3.19}, Expected{"boxes", 0.8, 3, 1.9},
                      Expected{"desk", 0.8, 3, 1.62}, Expected{"leaves", 1, 4, 2.78}),
    [](const auto& instance) { return instance.param.name; });

}  // namespace
}  // namespace saccade
