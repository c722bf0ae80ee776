#include "estimator/edges/window/node_correction.h"

#include <gtest/gtest.h>

namespace saccade {
namespace {

TEST(NodeCorrection, HasEvenNodesFromStartToEnd) {
  const NodeCorrection correction(1, 1.5, 0.11);
  EXPECT_EQ(correction.count(), 6);
  EXPECT_DOUBLE_EQ(correction.time_s(0), 1);
  EXPECT_DOUBLE_EQ(correction.time_s(5), 1.5);
  EXPECT_EQ(NodeCorrection(0, 0.01, 1).count(), 2) << "at least";
}

TEST(NodeCorrection, IsLinearBetweenNodesAndHeldBeyond) {
  NodeCorrection correction(0, 1, 0.5);
  EXPECT_EQ(correction.at(0.3).norm(), 0) << "none at first";
  for (int k = 0; k < 6; ++k) {
    correction.data(1)[k] = k + 1;
    correction.data(2)[k] = -k;
  }
  EXPECT_NEAR(correction.at(0.25)[2], 1.5, 1e-12);
  EXPECT_NEAR(correction.at(0.75)[2], 0.5 * 3 - 0.5 * 2, 1e-12);
  EXPECT_NEAR(correction.at(-1)[2], 0, 1e-12);
  EXPECT_NEAR(correction.at(7)[2], -2, 1e-12);
  const auto [node, share] = correction.before(0.75);
  EXPECT_EQ(node, 1);
  EXPECT_NEAR(share, 0.5, 1e-12);
  EXPECT_EQ(correction.before(1).first, 1) << "an end belongs to the last pair";
}

}  // namespace
}  // namespace saccade
