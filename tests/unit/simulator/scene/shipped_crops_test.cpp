#include <gtest/gtest.h>

#include <cstdio>
#include <string>

#include "core/config/config.h"
#include "simulator/motion/motion.h"
#include "simulator/scene/build_scene.h"
#include "simulator/simulation_config.h"
#include "tests/support/brute_force.h"

namespace saccade {
namespace {

/// A part of the picture of a shipped scene for a short time.
struct Crop {
  std::string config;
  int x0, y0;
  double start_s;
  double duration_s = 0.03;
  /// Less where more triangles stand between a light and what it lights than are predicted.
  double least_10_us = 0.999, least_1_us = 0.99;
};

class ShippedCrop : public ::testing::TestWithParam<Crop> {};

TEST_P(ShippedCrop, AgreesWithBruteForce) {
  const Crop& crop = GetParam();
  const auto config =
      config::read<SimulationConfig>(config::load("configs/simulation/" + crop.config + ".yaml"));
  const Scene scene = build_scene(config.scene);
  const Spline motion = cut_motion(build_motion(config.trajectory), crop.start_s, crop.duration_s);
  PinholeCamera camera = config.camera;
  camera.cx -= crop.x0;
  camera.cy -= crop.y0;
  camera.width = 36;
  camera.height = 24;
  const testing::Agreement result = testing::agreement(scene, motion, camera, config.events);
  const double path_px = testing::mean_path_px(scene, motion, camera);
  const double events_per_pixel =
      static_cast<double>(result.found) / (camera.width * camera.height);
  std::printf("%s; %.2f px of motion, %.2f events per pixel, budget of %.1f rays per event\n",
              result.text().c_str(), path_px, events_per_pixel,
              path_px / 0.5 / events_per_pixel + 4);
  EXPECT_GT(result.expected, 50U);
  EXPECT_GE(result.share_10_us(), crop.least_10_us);
  EXPECT_GE(result.share_1_us(), crop.least_1_us);
  EXPECT_LE(result.rays_per_event(), path_px / 0.5 / events_per_pixel + 4);
}

INSTANTIATE_TEST_SUITE_P(All, ShippedCrop,
                         ::testing::Values(Crop{"walls", 60, 40, 0.2}, Crop{"planes", 60, 40, 0.2},
                                           Crop{"dunes", 100, 80, 0.3},
                                           Crop{"office", 60, 100, 0.2, 0.02},
                                           Crop{"office", 20, 60, 0.8, 0.02},
                                           Crop{"desk", 100, 100, 0.3, 0.02, 0.998, 0.98},
                                           Crop{"boxes", 100, 80, 0.3, 0.02},
                                           Crop{"leaves", 100, 80, 0.2, 0.01},
                                           Crop{"moving_box", 100, 80, 0.4, 0.02}),
                         [](const auto& instance) {
                           const Crop& crop = instance.param;
                           return crop.config + "_" + std::to_string(crop.x0);
                         });

}  // namespace
}  // namespace saccade
