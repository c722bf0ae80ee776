#include "estimator/run/repeat.h"

#include <gtest/gtest.h>

namespace saccade {
namespace {

TEST(RepeatTimed, WorksAndTimesAsOftenAsAskedFor) {
  std::vector<double> wall_s{7};
  int count = 0;
  repeat_timed(3, wall_s, [&] { ++count; });
  EXPECT_EQ(count, 3);
  ASSERT_EQ(wall_s.size(), 4U) << "appended";
  for (std::size_t i = 1; i < wall_s.size(); ++i) EXPECT_GE(wall_s[i], 0);
}

}  // namespace
}  // namespace saccade
