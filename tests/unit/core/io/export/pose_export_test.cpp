#include "core/io/export/pose_export.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/config/config.h"
#include "core/io/colmap_file.h"
#include "core/io/trajectory_file.h"
#include "tests/support/command.h"
#include "tests/support/error_of.h"

namespace saccade {
namespace {

namespace fs = std::filesystem;
using testing::error_of;
using ::testing::HasSubstr;

class PoseExport : public ::testing::Test {
 protected:
  PoseExport() {
    folder_.write("data/calib.txt", "200 201 119.5 89.5 -0.1 0.01 0 0 0");
    folder_.write("data/camera.yaml",
                  "cam0: {camera_model: pinhole, intrinsics: [200, 201, 119.5, 89.5], "
                  "distortion_model: none, resolution: [240, 180]}\n");
    folder_.write("data/images.txt", "0.5 images/a.png\n1.5 images/b.png\n9 images/c.png\n");
  }
  testing::TemporaryFolder folder_;
  Trajectory trajectory_{
      {{0, Rigid3(so3_exp({0, 0, 0.5}), {0, 0, 0})}, {2, Rigid3(so3_exp({0, 0, 0.5}), {2, 4, 6})}}};
};

TEST_F(PoseExport, NerfstudioGetsTheFramesThatHaveAPose) {
  const Dataset dataset = Dataset::open(folder_.path() / "data");
  const fs::path file = folder_.path() / "data/transforms.json";
  EXPECT_EQ(write_nerfstudio(dataset, trajectory_, file), 2U);
  const config::Document json = config::load(file);
  EXPECT_EQ(json.root().find("cx")->value.text, "120");
  EXPECT_EQ(json.root().find("camera_model")->value.text, "OPENCV");
  const config::Node& frame = json.root().find("frames")->value.items.at(1);
  EXPECT_EQ(frame.find("file_path")->value.text, "images/b.png");
  const auto entry = [&](std::size_t r, std::size_t c) {
    return std::stod(frame.find("transform_matrix")->value.items.at(r).items.at(c).text);
  };
  EXPECT_NEAR(entry(0, 0), std::cos(0.5), 1e-12);
  EXPECT_NEAR(entry(0, 1), std::sin(0.5), 1e-12);  // -y of the camera
  EXPECT_NEAR(entry(2, 2), -1, 1e-12);             // backwards
  EXPECT_NEAR(entry(1, 3), 3, 1e-12);
  EXPECT_THAT(error_of([&] { return write_nerfstudio(dataset, Trajectory(), file); }),
              HasSubstr("has no frame at a time that has a pose"));
}

TEST_F(PoseExport, TheFolderOfRpgTrajectoryEvaluationHoldsBothTrajectories) {
  const fs::path out = folder_.path() / "evaluation";
  write_trajectory_evaluation(trajectory_, trajectory_, out);
  EXPECT_EQ(read_tum_trajectory(out / "stamped_groundtruth.txt").size(), 2U);
  EXPECT_EQ(read_tum_trajectory(out / "stamped_traj_estimate.txt").size(), 2U);
  EXPECT_THAT(error_of([&] {
                write_trajectory_evaluation(Trajectory(), trajectory_, out);
                return 0;
              }),
              HasSubstr("no ground truth"));
}

TEST_F(PoseExport, ColmapsPosesGetTheTimesOfTheirPictures) {
  const Rigid3 world_from_a(so3_exp({0.1, 0.2, 0.3}), {1, 2, 3});
  const Rigid3 a_from_world = world_from_a.inverse();
  const Eigen::Quaterniond& q = a_from_world.rotation();
  const Eigen::Vector3d& t = a_from_world.translation();
  std::ostringstream text;
  text.precision(17);
  text << "# Image list with two lines of data per image:\n# Number of images: 2\n"
       << "1 1 0 0 0 0 0 0 1 left/b.png\n\n"
       << "2 " << q.w() << " " << q.x() << " " << q.y() << " " << q.z() << " " << t.x() << " "
       << t.y() << " " << t.z() << " 1 left/a.png\n10.5 20.5 -1 30 40 7\n";
  const fs::path file = folder_.write("images.txt", text.str());
  EXPECT_TRUE(is_colmap_images(file));
  EXPECT_FALSE(is_colmap_images(folder_.path() / "data/images.txt"));
  const Trajectory trajectory =
      trajectory_of(read_colmap_images(file), {{"a.png", 0.5}, {"b.png", 1.5}});
  ASSERT_EQ(trajectory.size(), 2U);
  EXPECT_EQ(trajectory.start_s(), 0.5);
  EXPECT_LT((trajectory.poses()[0].world_from_camera.inverse() * world_from_a).log().norm(), 1e-12);
  EXPECT_THAT(error_of([&] {
                return trajectory_of(read_colmap_images(file), {{"a.png", 0.5}});
              }),
              HasSubstr("images.txt:3: the picture left/b.png is not in"));
  const fs::path bad = folder_.write("images.txt", "1 2 0 0 0 0 0 0 1 b.png\n\n");
  EXPECT_THAT(error_of([&] { return read_colmap_images(bad); }),
              HasSubstr("images.txt:1: the quaternion's length is 2"));
}

}  // namespace
}  // namespace saccade
