#include "core/io/trajectory_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/random.h"
#include "tests/support/command.h"
#include "tests/support/error_of.h"
#include "tests/support/shared_data.h"

namespace saccade {
namespace {

using testing::error_of;
using ::testing::HasSubstr;
using testing::TemporaryFolder;

Trajectory parse_poses(const std::string& text) {
  const TemporaryFolder folder;
  return read_trajectory(folder.write("poses.txt", text));
}

std::string error(const std::string& text) {
  return error_of([&] { return parse_poses(text); });
}

TEST(TrajectoryFile, ReadsTum) {
  const Trajectory t =
      parse_poses("# t tx ty tz qx qy qz qw\n0.5 1 2 3 0 0 0 1\n1.5 4 5 6 1 0 0 0\n");
  ASSERT_EQ(t.size(), 2U);
  EXPECT_EQ(t.start_s(), 0.5);
  EXPECT_EQ(t.poses()[1].world_from_camera.translation(), Eigen::Vector3d(4, 5, 6));
  EXPECT_EQ(t.poses()[1].world_from_camera.rotation().x(), 1);
}

TEST(TrajectoryFile, TheFirstLineOfACsvTellsTheOrderOfTheQuaternion) {
  for (const char* header :
       {"# timestamp, x, y, z, qx, qy, qz, qw\n", "timestamp,tx,ty,tz,qx,qy,qz,qw\n"}) {
    const Trajectory t = parse_poses(std::string(header) + "500000000, 1,2, 3,0,0,0.6,0.8\n");
    ASSERT_EQ(t.size(), 1U);
    EXPECT_EQ(t.start_s(), 0.5);
    EXPECT_EQ(t.poses()[0].world_from_camera.translation(), Eigen::Vector3d(1, 2, 3));
    EXPECT_EQ(t.poses()[0].world_from_camera.rotation().w(), 0.8);
  }
  const Trajectory euroc = parse_poses(
      "#timestamp, p_RS_R_x [m], p_RS_R_y [m], p_RS_R_z [m], q_RS_w [], q_RS_x [], q_RS_y [], "
      "q_RS_z [], v_RS_R_x [m s^-1], v_RS_R_y [m s^-1], v_RS_R_z [m s^-1]\n"
      "1403636580838555648,4.5,-1.7,0.7,0.8,0.6,0,0,0.1,0.2,0.3\n");
  ASSERT_EQ(euroc.size(), 1U);
  EXPECT_EQ(euroc.poses()[0].world_from_camera.translation(), Eigen::Vector3d(4.5, -1.7, 0.7));
  EXPECT_EQ(euroc.poses()[0].world_from_camera.rotation().w(), 0.8);
  EXPECT_EQ(euroc.poses()[0].world_from_camera.rotation().x(), 0.6);
}

TEST(TrajectoryFile, ACsvWithoutNamesIsAskedForThem) {
  for (const char* header :
       {"", "timestamp,x,y,z\n", "# a,b,c,d,e,f,g,h\n", "# timestamp, x, y, z, qx, qy, qz, qx\n"})
    EXPECT_THAT(error(std::string(header) + "500000000,1,2,3,0,0,0,1\n"),
                HasSubstr("poses.txt:1: the first line must name the columns"));
}

TEST(TrajectoryFile, OrientationsAreExactAndHaveNoPosition) {
  const TemporaryFolder folder;
  const std::filesystem::path file = folder.path() / "orientation.txt";
  const std::vector<StampedPose> poses{{0.25, {so3_exp({0.1, 2, -0.3}), {1, 2, 3}}}, {0.5, {}}};
  write_orientations(file, poses);
  const Trajectory read = read_orientations(file);
  ASSERT_EQ(read.size(), 2U);
  EXPECT_EQ(read.poses()[0].t_s, 0.25);
  EXPECT_LT(angle_between(read.poses()[0].world_from_camera.rotation(),
                          poses[0].world_from_camera.rotation()),
            1e-15);
  EXPECT_EQ(read.poses()[0].world_from_camera.translation().norm(), 0);
  const auto error = [&](const std::string& text) {
    return error_of([&] { return read_orientations(folder.write("orientation.txt", text)); });
  };
  EXPECT_THAT(error("0 0 0 0 2\n"), HasSubstr("orientation.txt:1: the quaternion's length is 2"));
  EXPECT_THAT(error("1 0 0 0 1\n0 0 0 0 1\n"), HasSubstr("orientation.txt:2: times must"));
  EXPECT_THAT(error("1 0 0 0 1 5\n"), HasSubstr("more fields"));
}

TEST(TrajectoryFile, NormalisesSlightlyWrongQuaternions) {
  const Trajectory t = parse_poses("0 0 0 0 0 0 0 1.0009\n");
  EXPECT_DOUBLE_EQ(t.poses()[0].world_from_camera.rotation().w(), 1);
}

TEST(TrajectoryFile, NamesTheLineOfWhatIsWrong) {
  EXPECT_THAT(error("0 0 0 0 0 0 0 1\n1 0 0 0 0 0 0 0\n"),
              HasSubstr("poses.txt:2: the quaternion's length is 0; a rotation's is 1"));
  EXPECT_THAT(error("0 0 0 0 0 0 0 1.01\n"), HasSubstr("poses.txt:1: the quaternion's length"));
  EXPECT_THAT(error("0 0 nan 0 0 0 0 1\n"), HasSubstr("poses.txt:1: ty: expected a finite number"));
  EXPECT_THAT(error("0 0 0 0 0 0 0 nan\n"), HasSubstr("qw: expected a finite number"));
  EXPECT_THAT(error("1 0 0 0 0 0 0 1\n1 0 0 0 0 0 0 1\n"),
              HasSubstr("poses.txt:2: times must increase: 1.000000000 s after"));
  EXPECT_THAT(error("0 0 0 0 0 0 1\n"), HasSubstr("poses.txt:1: qw: expected a number"));
  EXPECT_THAT(error("0 0 0 0 0 0 0 1 9\n"), HasSubstr("poses.txt:1: more fields"));
  const std::string names = "# t,x,y,z,qx,qy,qz,qw\n";
  EXPECT_THAT(error(names + "5,0,0,0,0,0,0,1\n4,0,0,0,0,0,0,1\n"),
              HasSubstr("poses.txt:3: times must"));
  EXPECT_THAT(error(names + "0.5,0,0,0,0,0,0,1\n"),
              HasSubstr("timestamp: expected a whole number"));
  EXPECT_THAT(error(names + "5,0,0,0,0,0,0,2\n"), HasSubstr("the quaternion's length is 2"));
  EXPECT_THAT(error(names + "5,0,0,0,0,0,0\n"), HasSubstr("poses.txt:2: a column of the pose"));
  EXPECT_THAT(error(names + "5,0,0,0,0,0,0,1,9\n"), HasSubstr("poses.txt:2: more fields"));
  EXPECT_THAT(error(""), HasSubstr("poses.txt: holds no poses"));
  EXPECT_THAT(error("# only a comment\n"), HasSubstr("holds no poses"));
  EXPECT_THAT(error_of([] { return read_trajectory("/nowhere/x.txt"); }),
              HasSubstr("no such file"));
}

TEST(TrajectoryFile, RoundTripIsExact) {
  const Random random(5);
  std::vector<StampedPose> poses;
  for (std::uint64_t i = 0; i < 200; ++i) {
    const auto draw = [&](std::uint64_t stream) { return random.normal(stream, i); };
    poses.push_back({1'468'939'993 + 0.001 * static_cast<double>(i),
                     {so3_exp({draw(0), draw(1), draw(2)}), {draw(3), draw(4), draw(5)}}});
  }
  const TemporaryFolder folder;
  write_tum_trajectory(folder.path() / "out.txt", poses);
  const Trajectory read = read_tum_trajectory(folder.path() / "out.txt");
  ASSERT_EQ(read.size(), poses.size());
  for (std::size_t i = 0; i < poses.size(); ++i) {
    EXPECT_NEAR(read.poses()[i].t_s, poses[i].t_s, 5e-10);
    const Rigid3& a = read.poses()[i].world_from_camera;
    const Rigid3& b = poses[i].world_from_camera;
    EXPECT_EQ(a.translation(), b.translation());
    EXPECT_LT((a.rotation().coeffs() - b.rotation().coeffs()).norm(), 1e-15);
  }
}

TEST(ObjectPoses, RoundTripIsExact) {
  const TemporaryFolder folder;
  const std::vector<ObjectPose> poses{{0, 2, {so3_exp({0.1, 0.2, 0.3}), {1, -2, 1.0 / 3}}},
                                      {0, 5, {}},
                                      {0.001, 2, {so3_exp({-1, 0.2, 2}), {4, 5, 6}}}};
  write_object_poses(folder.path() / "objects.txt", poses);
  const std::vector<ObjectPose> read = read_object_poses(folder.path() / "objects.txt");
  ASSERT_EQ(read.size(), poses.size());
  for (std::size_t i = 0; i < poses.size(); ++i) {
    EXPECT_EQ(read[i].t_s, poses[i].t_s);
    EXPECT_EQ(read[i].object, poses[i].object);
    const Rigid3& a = read[i].world_from_object;
    const Rigid3& b = poses[i].world_from_object;
    EXPECT_EQ(a.translation(), b.translation());
    EXPECT_LT((a.rotation().coeffs() - b.rotation().coeffs()).norm(), 1e-15);
  }
}

TEST(ObjectPoses, NamesTheLineOfWhatIsWrong) {
  const TemporaryFolder folder;
  const auto error_in = [&](const std::string& text) {
    return error_of([&] { return read_object_poses(folder.write("objects.txt", text)); });
  };
  EXPECT_THAT(error_in("# t object\n0 -1 0 0 0 0 0 0 1\n"), HasSubstr("objects.txt:2: object -1"));
  EXPECT_THAT(error_in("0 1 0 0 0 0 0 0 1\n0 1 0 0 0 0 0 0 1\n"),
              HasSubstr("objects.txt:2: lines must be in order"));
  EXPECT_THAT(error_in("0 1.5 0 0 0 0 0 0 1\n"), HasSubstr("object: expected a whole number"));
  EXPECT_THAT(error_in("0 1 0 0 0 0 0 1\n"), HasSubstr("objects.txt:1: qw"));
}

TEST(AngularVelocities, ComeBackAndNameTheLineOfWhatIsWrong) {
  const TemporaryFolder folder;
  const std::vector<StampedTwist> written = {{0.1, Eigen::Vector3d::Zero(), {1.0 / 3, -2, 3e-9}},
                                             {0.2, Eigen::Vector3d::Zero(), {0, 1e5, -0.1}}};
  const auto file = folder.path() / "angular_velocity.txt";
  write_angular_velocities(file, written);
  const std::vector<StampedTwist> read = read_angular_velocities(file);
  ASSERT_EQ(read.size(), 2U);
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_EQ(read[i].t_s, written[i].t_s);
    EXPECT_EQ(read[i].angular_velocity, written[i].angular_velocity);
    EXPECT_EQ(read[i].velocity, Eigen::Vector3d::Zero());
  }
  const auto error_in = [&](const std::string& text) {
    return error_of([&] { return read_angular_velocities(folder.write("w.txt", text)); });
  };
  EXPECT_THAT(error_in("# t wx wy wz\n0 1 2\n"), HasSubstr("w.txt:2: wz"));
  EXPECT_THAT(error_in("0 1 2 x\n"), HasSubstr("w.txt:1: wz"));
  EXPECT_THAT(error_in("0.2 1 2 3\n0.1 1 2 3\n"), HasSubstr("w.txt:2"));
}

TEST(TrajectoryFile, ReadsHandHeldMotion) {
  SACCADE_SHARED_DATA_OR_SKIP(file, "trajectories/poster_6dof_handheld.csv");
  const Trajectory t = read_trajectory(file);
  EXPECT_GT(t.size(), 10'000U);
  EXPECT_NEAR(t.end_s() - t.start_s(), 59.8, 0.1);
}

TEST(CsvTrajectory, IsToldByTheNamesOfItsColumns) {
  const testing::TemporaryFolder folder;
  EXPECT_TRUE(is_csv_trajectory(
      folder.write("a.csv", "\n# timestamp, x, y, z, qx, qy, qz, qw\n1,0,0,0,0,0,0,1\n")));
  EXPECT_FALSE(is_csv_trajectory(folder.write("b.csv", "0.5,1,2,1\n")));
  EXPECT_FALSE(is_csv_trajectory(folder.path() / "none.csv"));
  EXPECT_FALSE(is_csv_trajectory(folder.path()));
}

}  // namespace
}  // namespace saccade
