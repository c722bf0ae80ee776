#include "eval/calibration/stream_distance.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace saccade {
namespace {

TEST(GapDistance, OfGapsThatAreAllLongerByAFactorIsItsLogarithm) {
  std::vector<double> gaps, longer;
  for (int i = 1; i <= 200; ++i) {
    gaps.push_back(100.0 * i * i);
    longer.push_back(2.5 * gaps.back());
  }
  EXPECT_NEAR(gap_distance(gaps, longer), std::log10(2.5), 1e-12);
  EXPECT_EQ(gap_distance(gaps, gaps), 0);
  EXPECT_EQ(gap_distance(gaps, {}), 0);
}

TEST(GapDistance, DoesNotDependOnHowManyThereAre) {
  const std::vector<double> one{100, 1000};
  const std::vector<double> same{100, 100, 100, 1000, 1000, 1000};
  EXPECT_NEAR(gap_distance(one, same), 0, 1e-12);
  // Half of the gaps move by a decade.
  EXPECT_NEAR(gap_distance(one, std::vector<double>{1000, 1000}), 0.5, 1e-12);
}

TEST(StreamDistance, CountsByHand) {
  const Events recorded{{0, 0, 0, 1}, {1'000'000, 9, 0, -1}};
  const Events simulated{{0, 0, 0, 1}, {6'000'000, 0, 0, 1}, {7'000'000, 1, 0, -1}};
  const StreamDistance d = stream_distance(recorded, simulated, {16, 8});
  EXPECT_DOUBLE_EQ(d.event_ratio, 1.5);
  EXPECT_NEAR(d.on_points, 100 * (2.0 / 3 - 0.5), 1e-9);
  EXPECT_NEAR(d.rate_variation, 2.0 / 3, 1e-9);  // all of the recorded come in the first 5 ms
  EXPECT_NEAR(d.map_variation, 0.5, 1e-9);       // all of the simulated are in the left block
}

}  // namespace
}  // namespace saccade
