#include "estimator/depth/thesis/grid_keypoints.h"

#include <gtest/gtest.h>

namespace saccade {
namespace {

TEST(GridKeypoints, AreTheCentresOfMassOfFullCells) {
  ImageF frame(10, 8);
  frame(1, 1) = 3;
  frame(2, 1) = 1;  // the first cell: centre at (1.25, 1)
  frame(6, 5) = 2;  // alone in its cell
  frame(5, 1) = 0.01F;
  const auto keypoints = find_keypoints(frame, 4, 0.5);
  ASSERT_EQ(keypoints.size(), 2U);
  EXPECT_EQ(keypoints[0], Eigen::Vector2f(1.25F, 1));
  EXPECT_EQ(keypoints[1], Eigen::Vector2f(6, 5));
}

TEST(GridKeypoints, LeavesOutCellsThatTheBorderCuts) {
  ImageF frame(10, 8);
  frame(9, 3) = 1;
  EXPECT_TRUE(find_keypoints(frame, 4, 0.3).empty());
  EXPECT_EQ(find_keypoints(frame, 5, 0.3).size(), 1U);
}

TEST(GridKeypoints, AnEmptyFrameHasNone) {
  EXPECT_TRUE(find_keypoints(ImageF(16, 16), 3, 0.3).empty());
  EXPECT_TRUE(find_keypoints(ImageF(16, 16), 4, 0).empty());
}

}  // namespace
}  // namespace saccade
