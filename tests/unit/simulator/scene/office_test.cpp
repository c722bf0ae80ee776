#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <limits>

#include "core/config/config.h"
#include "core/random.h"
#include "simulator/motion/motion.h"
#include "simulator/scene/build_scene.h"
#include "simulator/simulation_config.h"

namespace saccade {
namespace {

constexpr const char* kFurniture = "/usr/share/sweethome3d/furniture";
constexpr std::size_t kPacket = 16;

/// Distances along 16 rays.
std::array<double, kPacket> distances(const Scene& scene, const std::array<Ray, kPacket>& rays) {
  std::array<TriangleId, kPacket> triangles;
  scene.visible(rays, triangles);
  std::array<double, kPacket> result;
  for (std::size_t i = 0; i < kPacket; ++i) result[i] = scene.shade(rays[i], triangles[i]).distance;
  return result;
}

/// Mean z depth over every other pixel of a view.
double mean_depth(const Scene& scene, const PinholeCamera& camera, const Rigid3& pose) {
  double sum = 0;
  std::array<Ray, kPacket> rays;
  for (int y = 0; y < camera.height; y += 2)
    for (int x = 0; x < camera.width; x += 2 * static_cast<int>(kPacket)) {
      for (std::size_t i = 0; i < kPacket; ++i) {
        const Eigen::Vector2d pixel(std::min(x + 2 * static_cast<int>(i), camera.width - 1), y);
        rays[i] = {pose.translation(), pose.rotation() * camera.ray(pixel)};
      }
      for (const double distance : distances(scene, rays)) sum += distance;
    }
  const double rows = std::ceil(camera.height / 2.0);
  const double columns = std::ceil(camera.width / (2.0 * kPacket)) * kPacket;
  return sum / (rows * columns);
}

/// How far the nearest of many surfaces around a point is [m].
double clearance(const Scene& scene, const Eigen::Vector3d& position) {
  const Random random(1);
  double nearest = std::numeric_limits<double>::infinity();
  std::array<Ray, kPacket> rays;
  for (std::uint64_t packet = 0; packet < 100; ++packet) {
    for (std::uint64_t i = 0; i < kPacket; ++i) {
      const Eigen::Vector3d direction(random.normal(0, packet * kPacket + i),
                                      random.normal(1, packet * kPacket + i),
                                      random.normal(2, packet * kPacket + i));
      rays[i] = {position, direction.normalized()};
    }
    for (const double distance : distances(scene, rays))
      if (distance > 0) nearest = std::min(nearest, distance);
  }
  return nearest;
}

TEST(Office, PathKeepsItsRatioToTheDepthAndItsDistanceToTheFurniture) {
  if (!std::filesystem::exists(kFurniture))
    GTEST_SKIP() << kFurniture << " is missing: apt-get install sweethome3d-furniture";
  auto config = config::read<SimulationConfig>(config::load("configs/simulation/office.yaml"));
  config.scene.lighting = Lighting::kNone;
  const Scene scene = build_scene(config.scene);
  EXPECT_LT(scene.triangle_count(), 500'000U);

  const Spline motion = build_motion(config.trajectory);
  double depth = 0;
  double length = 0;
  Eigen::Vector3d last = motion.pose(motion.start_s()).translation();
  for (int step = 0; step <= 100; ++step) {
    const Rigid3 pose = motion.pose(motion.start_s() + 0.01 * step);
    length += (pose.translation() - last).norm();
    last = pose.translation();
    if (step % 10 != 0) continue;
    depth += mean_depth(scene, config.camera, pose) / 11;
    EXPECT_GT(clearance(scene, pose.translation()), 0.5) << step;
  }
  EXPECT_NEAR(length / depth, 0.41, 0.05 * 0.41);
}

}  // namespace
}  // namespace saccade
