#include "estimator/external/external_output.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/command.h"
#include "tests/support/error_of.h"

namespace saccade {
namespace {

using ::testing::AllOf;
using testing::error_of;
using ::testing::HasSubstr;
using testing::TemporaryFolder;

class ExternalTrajectory : public ::testing::Test {
 protected:
  [[nodiscard]] std::vector<StampedPose> read(const std::string& text,
                                              const TrajectoryFormat& format = {}) const {
    return read_external_trajectory(folder_.write("poses.txt", text), format);
  }

  TemporaryFolder folder_;
};

TEST_F(ExternalTrajectory, ReadsTum) {
  const auto poses = read("# t x y z q\n1.5 1 2 3 0 0 0 1\n1.6 1 2 4 0 0.6 0 0.8\n");
  ASSERT_EQ(poses.size(), 2U);
  EXPECT_EQ(poses[0].t_s, 1.5);
  EXPECT_EQ(poses[1].world_from_camera.translation().z(), 4);
  EXPECT_NEAR(poses[1].world_from_camera.rotation().y(), 0.6, 1e-15);
}

TEST_F(ExternalTrajectory, ReadsEurocInNanosecondsWithColumnNames) {
  TrajectoryFormat format;
  format.columns = TrajectoryFormat::Columns::kEuroc;
  format.timestamp_unit = StampUnit::kNanoseconds;
  format.time_offset_s = -1403636579;
  const auto poses =
      read("timestamp,x,y,z,qw,qx,qy,qz\n1403636579250000000,1,2,3,0.8,0,0.6,0\n", format);
  ASSERT_EQ(poses.size(), 1U);
  EXPECT_NEAR(poses[0].t_s, 0.25, 1e-6);
  EXPECT_NEAR(poses[0].world_from_camera.rotation().w(), 0.8, 1e-15);
}

TEST_F(ExternalTrajectory, TurnsCameraFromWorldAround) {
  TrajectoryFormat format;
  format.poses = TrajectoryFormat::Convention::kCameraFromWorld;
  format.timestamp_unit = StampUnit::kMilliseconds;
  const auto poses = read("250 1 2 3 0 0 0.6 0.8\n", format);
  EXPECT_DOUBLE_EQ(poses.at(0).t_s, 0.25);
  const Rigid3 given(Eigen::Quaterniond(0.8, 0, 0, 0.6), {1, 2, 3});
  EXPECT_LT((poses[0].world_from_camera * given).log().norm(), 1e-12);
}

TEST_F(ExternalTrajectory, NamesTheLineOfWhatIsWrong) {
  const auto error = [&](const std::string& second) {
    return error_of([&] { return read("0.1 0 0 0 0 0 0 1\n" + second + "\n"); });
  };
  EXPECT_THAT(error("0.1 0 0 0 0 0 0 1"), AllOf(HasSubstr("poses.txt:2"), HasSubstr("increase")));
  EXPECT_THAT(error("0.05 0 0 0 0 0 0 1"), HasSubstr("increase"));
  EXPECT_THAT(error("0.2 nan 0 0 0 0 0 1"), HasSubstr("finite"));
  EXPECT_THAT(error("0.2 0 0 0 0 0 0 2"), HasSubstr("quaternion"));
  EXPECT_THAT(error("0.2 0 0 0 0 0 0"), HasSubstr("poses.txt:2"));
  EXPECT_THAT(error("0.2 0 0 0 0 0 0 1 9"), HasSubstr("poses.txt:2"));
  EXPECT_TRUE(read("").empty());
}

}  // namespace
}  // namespace saccade
