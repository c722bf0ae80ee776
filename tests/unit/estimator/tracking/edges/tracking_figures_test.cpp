#include "estimator/tracking/edges/tracking_figures.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <numeric>
#include <string>
#include <utility>

#include "core/io/images/exr_file.h"
#include "tests/support/command.h"
#include "tests/support/planar_world.h"

namespace saccade {
namespace {

using testing::PlanarWorld;

constexpr double kDepth_m = 1.5;
constexpr int kSamples = 40;

/// One textured wall that fills the view of a small camera.
PlanarWorld wall() { return testing::wall_world(80, 60, 66, kDepth_m, 210, 158); }

Rigid3 motion(double t_s) { return {Eigen::Quaterniond::Identity(), {0.9 * t_s, 0.3 * t_s, 0}}; }

double sum(const ImageF& image) {
  return std::accumulate(image.pixels().begin(), image.pixels().end(), 0.0);
}

/// The figures of the true pose after 0.2 s.
class TrackingFigures : public ::testing::Test {
 protected:
  TrackingFigures() {
    const PlanarWorld world = wall();
    const ImageF depth(80, 60, static_cast<float>(kDepth_m));
    const ReferenceView reference{world.log_intensity({}), depth, {}};
    const MapPoints map = extract_map(reference.log_intensity, depth, world.camera(), {});
    const Events events = world.simulate(motion, 0.18, 0.22, 1e-3, 0.12);
    EdgeTrackerOptions options = edge_preset(EdgeTrackerOptions::Preset::kThesis);
    options.align.samples = kSamples;
    write_tracking_figures(folder_.path(), options, world.camera(), reference, map,
                           {events, motion(0.2)});
    for (ExrChannel& channel : read_exr_channels(folder_.path() / "figures" / "tracking.exr"))
      images_[channel.name] = std::move(channel.image);
  }

  [[nodiscard]] const ImageF& image(const std::string& name) const { return images_.at(name); }

  testing::TemporaryFolder folder_;
  std::map<std::string, ImageF> images_;
};

TEST_F(TrackingFigures, TheMapIsDrawnAtItsDepthAndWidenedByTheBlur) {
  const ImageF& mask = image("mask");
  EXPECT_GT(sum(mask), 100);
  for (int y = 0; y < mask.height(); ++y)
    for (int x = 0; x < mask.width(); ++x) {
      EXPECT_NEAR(image("mask_depth")(x, y), mask(x, y) > 0 ? kDepth_m : 0, 1e-3);
      if (mask(x, y) > 0) {
        EXPECT_GT(image("template")(x, y), 0.1);
      }
    }
  const auto lit = [](const ImageF& of) {
    return std::count_if(of.pixels().begin(), of.pixels().end(), [](float v) { return v > 0.01F; });
  };
  EXPECT_GT(lit(image("template_depth")), lit(image("mask_depth")));
}

TEST_F(TrackingFigures, MapPointsHaveTheSteepestGradients) {
  double least = 1e9;
  double most_outside = 0;
  for (int y = 1; y + 1 < 60; ++y)
    for (int x = 1; x + 1 < 80; ++x) {
      const double gradient = image("gradient")(x, y);
      if (image("map")(x, y) > 0)
        least = std::min(least, gradient);
      else
        most_outside = std::max(most_outside, gradient);
    }
  EXPECT_GE(least, most_outside);
}

TEST_F(TrackingFigures, EventsFallOnTheTemplateOfTheirPose) {
  double on_template = 0, lit = 0;
  for (int y = 0; y < 60; ++y)
    for (int x = 0; x < 80; ++x) {
      if (!(image("template")(x, y) > 0.01F)) continue;
      ++lit;
      on_template += image("events")(x, y);
    }
  ASSERT_GT(sum(image("events")), 50);
  EXPECT_GT(on_template / sum(image("events")), 1.3 * lit / (80 * 60)) << "by more than chance";
}

TEST_F(TrackingFigures, SelectionsArePartsOfTheTemplate) {
  for (const char* part : {"semi_dense", "sparse_patches", "random"})
    for (int y = 0; y < 60; ++y)
      for (int x = 0; x < 80; ++x) EXPECT_LE(image(part)(x, y), image("dense")(x, y)) << part;
  EXPECT_EQ(sum(image("random")), kSamples);
  EXPECT_GT(sum(image("semi_dense")), kSamples);
  EXPECT_LT(sum(image("semi_dense")), 0.6 * sum(image("dense")));
}

}  // namespace
}  // namespace saccade
