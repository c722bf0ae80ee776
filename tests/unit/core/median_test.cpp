#include "core/median.h"

#include <gtest/gtest.h>

namespace saccade {
namespace {

TEST(Median, IsTheMiddleValueOrTheMeanOfTheTwo) {
  EXPECT_EQ(median({3}), 3);
  EXPECT_EQ(median({5, 1}), 3);
  EXPECT_EQ(median({9, 1, 4}), 4);
  EXPECT_EQ(median({8, 1, 2, 4}), 3);
  EXPECT_EQ(median({2, 2, 7, 2}), 2);
}

}  // namespace
}  // namespace saccade
