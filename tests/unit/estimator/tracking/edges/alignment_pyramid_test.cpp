#include "estimator/tracking/edges/alignment_pyramid.h"

#include <gtest/gtest.h>

#include "tests/unit/estimator/tracking/edges/synthetic_template.h"

namespace saccade {
namespace {

using testing::pixels_between;
using testing::random_frame;
using testing::rectangle_map;
using testing::small_camera;

/// A slide that moves the image of points 2 m away by `px`, half of it sideways, and turns it.
Rigid3 slide(double px) {
  const double metres = 2 * px / small_camera().fx;
  return {so3_exp({0, 0, 0.004 * px}), {0.8 * metres, -0.5 * metres, 0}};
}

/// What the levels make of a first guess, and where the truth is.
struct World {
  MapPoints map = rectangle_map();
  TemplateDrawer drawer{small_camera(), {}, map};
  std::span<const TemplatePoint> points = drawer.draw({});
  EventFrame frame = random_frame(map, {}, 0.8, 0.05, 1);

  [[nodiscard]] std::optional<Rigid3> approach(int levels, const Rigid3& prediction,
                                               double precision = 0) const {
    AlignOptions options;
    options.pyramid_levels = levels;
    AlignmentPyramid coarse({}, options, small_camera());
    coarse.set_template(drawer);
    return coarse.approach(frame, prediction, precision * Matrix6::Identity(), 1, 0);
  }
};

/// From how many of 16 starts, 8 to 22 px away, the alignment comes home.
int recovered(const World& world, int levels) {
  TemplateAligner full({}, small_camera());
  full.set_template(world.points);
  int count = 0;
  for (int px = 8; px < 24; px += 2)
    for (const int sign : {-1, 1}) {
      const Rigid3 start = slide(sign * px);
      const AlignResult aligned =
          full.align(world.frame, start, Matrix6::Zero(), {}, 1, 0, world.approach(levels, start));
      count += pixels_between(world.points, aligned.current_from_template, {}) < 0.5 ? 1 : 0;
    }
  return count;
}

TEST(AlignmentPyramid, PullFromFartherAwayThanTheFullResolution) {
  const World world;
  const int alone = recovered(world, 1);
  const int two = recovered(world, 2);
  const int three = recovered(world, 3);
  EXPECT_GT(two, alone);
  EXPECT_GT(three, two);
}

TEST(AlignmentPyramid, StayWhereTheTruthIs) {
  const World world;
  for (const int levels : {2, 3, 8}) {
    const auto guess = world.approach(levels, {});
    ASSERT_TRUE(guess);
    EXPECT_LT(pixels_between(world.points, *guess, {}), 0.5) << levels;
  }
}

TEST(AlignmentPyramid, OneLevelHasNoGuess) { EXPECT_FALSE(World().approach(1, {})); }

TEST(AlignmentPyramid, AStrongPredictionHolds) {
  const World world;
  const Rigid3 prediction = slide(3);
  EXPECT_LT(pixels_between(world.points, *world.approach(3, prediction, 1e14), prediction), 0.01);
}

TEST(AlignmentPyramid, AnEmptyTemplateKeepsThePrediction) {
  World world;
  world.map = {};
  TemplateDrawer nothing(small_camera(), {}, world.map);
  static_cast<void>(nothing.draw({}));
  AlignOptions options;
  options.pyramid_levels = 3;
  AlignmentPyramid coarse({}, options, small_camera());
  coarse.set_template(nothing);
  const auto guess = coarse.approach(world.frame, slide(2), Matrix6::Zero(), 1, 0);
  ASSERT_TRUE(guess);
  EXPECT_EQ(guess->translation(), slide(2).translation());
}

}  // namespace
}  // namespace saccade
