#include "apps/pose_option.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/error_of.h"

namespace saccade {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

std::string problem(const std::string& text) {
  return testing::error_of([&] { return parse_pose(text, "--overlay-pose"); });
}

TEST(PoseOption, PositionThenQuaternion) {
  const Rigid3 pose = parse_pose(" -1 2e0\t.5, 0 0.6 0 -0.8 ", "--overlay-pose");
  EXPECT_EQ(pose.translation(), Eigen::Vector3d(-1, 2, 0.5));
  EXPECT_LT(angle_between(pose.rotation(), Eigen::Quaterniond(-0.8, 0, 0.6, 0)), 1e-9);
}

TEST(PoseOption, AnotherNumberOfNumbers) {
  for (const auto& [text, count] : {std::pair{"1 2 3 0 0 1", "6 numbers instead of 7"},
                                    {"1 2 3 0 0 0 1 4", "8 numbers instead of 7"},
                                    {"1", "1 number instead of 7"},
                                    {"", "0 numbers instead of 7"}})
    EXPECT_THAT(problem(text), AllOf(HasSubstr("--overlay-pose: "), HasSubstr(count),
                                     HasSubstr("\"x y z qx qy qz qw\"")));
}

TEST(PoseOption, NamesTheCharacter) {
  EXPECT_THAT(problem("1 2 zwei 0 0 0 1"), HasSubstr("character 5 (z): 'zwei' is no number"));
  EXPECT_THAT(problem("1 2 3 0 0 0 nan"), HasSubstr("character 13 (qw): 'nan' is no number"));
  EXPECT_THAT(problem("1;2;3;0;0;0;1"), HasSubstr("character 1 (x)"));
  EXPECT_THAT(problem("1 2 3 0 0 0 1 x"), HasSubstr("character 15: 'x'"));
}

TEST(PoseOption, ARotationHasLengthOne) {
  EXPECT_THAT(problem("0 0 0 0 0 0 2"), HasSubstr("length 2 instead of 1 (did you mean 0 0 0 1?)"));
  EXPECT_THAT(problem("0 0 0 0 0 0 0"), HasSubstr("is zero"));
}

}  // namespace
}  // namespace saccade
