#include "simulator/rig.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>

#include "core/config/config.h"
#include "core/io/dataset/dataset.h"
#include "core/io/images/image_file.h"
#include "core/process/progress.h"
#include "core/srgb.h"
#include "simulator/simulate.h"
#include "tests/support/closed_form_plane.h"
#include "tests/support/command.h"
#include "tests/support/error_of.h"

namespace saccade {
namespace {

using ::testing::AllOf;
using testing::ClosedFormPlane;
using ::testing::ElementsAre;
using testing::error_of;
using ::testing::HasSubstr;
using testing::TemporaryFolder;

constexpr double kBaseline_m = 0.2;
constexpr const char* kRight =
    "T_camera0_camera: [[1, 0, 0, 0.2], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]]";

/// Cameras before a plane.
class Rig : public ::testing::Test {
 protected:
  void SetUp() override {
    set_progress_quiet(true);
    plane_.duration_s = 0.1;
    mesh_ = plane_.write_mesh(folder_.path());
  }
  void TearDown() override { set_progress_quiet(false); }

  [[nodiscard]] SimulationConfig config(const std::string& more) const {
    const Eigen::Vector2d end = plane_.duration_s * plane_.velocity;
    return config::read<SimulationConfig>(config::parse(
        "scene: {meshes: [{file: " + mesh_.string() + "}]}\n" +
            "trajectory: {source: waypoints, waypoints: [[0, 0, 0, 0, 0, 0, 0, 1], [0.1, " +
            std::to_string(end.x()) + ", " + std::to_string(end.y()) + ", 0, 0, 0, 0, 1]]}\n" +
            "camera: {width: 61, height: 46, fx: 100, fy: 100, cx: 28}\n" + more,
        "test.yaml", folder_.path()));
  }
  [[nodiscard]] std::filesystem::path output() const { return folder_.path() / "out"; }

  TemporaryFolder folder_;
  ClosedFormPlane plane_ = ClosedFormPlane::smooth(61, 46);
  std::filesystem::path mesh_;
};

TEST_F(Rig, FurtherCamerasInheritFromTheFirst) {
  const SimulationConfig rig =
      config(std::string("events: {contrast_on: 0.3, log_eps: 0.01}\n") + "rig:\n  - {" + kRight +
             "}\n  - {" + kRight + ", camera: {width: 80}, events: {contrast_on: 0.1}}\n");
  const std::vector<RigCamera> cameras = rig_cameras(rig);
  ASSERT_EQ(cameras.size(), 3U);
  EXPECT_EQ(cameras[1].camera, rig.camera);
  EXPECT_EQ(cameras[1].events.contrast.on, 0.3);
  EXPECT_EQ(cameras[2].camera.cx, 39.5);
  EXPECT_EQ(cameras[2].camera.fx, 100);
  EXPECT_EQ(cameras[2].events.contrast.on, 0.1);
  EXPECT_EQ(cameras[2].events.log_eps, 0.01);
  EXPECT_EQ(cameras[0].seed, rig.seed);
  EXPECT_NE(cameras[1].seed, cameras[0].seed);
  EXPECT_NE(cameras[2].seed, cameras[1].seed);
  EXPECT_EQ(cameras[2].folder, "cam2");
  EXPECT_EQ(
      config::print(config::read<SimulationConfig>(config::parse(config::print(rig), "printed"))),
      config::print(rig));
}

TEST_F(Rig, APairSeesThePlaneWithItsDisparity) {
  simulate(config(std::string("events: {timestamp_unit: ns}\nrig: [{") + kRight + "}]\n"),
           output());
  const Dataset left = Dataset::open(output());
  const Dataset right = Dataset::open(output() / "cam1");
  const double disparity = left.camera().fx * kBaseline_m / plane_.distance_m;
  ASSERT_EQ(disparity, 10);
  for (std::size_t i = 0; i < left.frames().size(); ++i) {
    const ImageF a = left.load_frame(i);
    const ImageF b = right.load_frame(i);
    const ImageF depth = right.load_depth(i);
    for (int y = 0; y < 46; ++y)
      for (int x = 0; x + 10 < 61; ++x) {
        EXPECT_NEAR(b(x, y), a(x + 10, y), 1e-5F * a(x + 10, y));
        EXPECT_NEAR(depth(x, y), plane_.distance_m, 1e-6);
      }
  }
  // Pixel x of the right camera sees what pixel x + 10 of the left one does, and so do its events.
  const auto inner = [](const Events& events, int from) {
    return std::count_if(events.begin(), events.end(),
                         [&](const Event& e) { return e.x >= from && e.x < from + 51; });
  };
  const auto in_left = static_cast<double>(inner(left.load_events(), 10));
  EXPECT_GT(in_left, 1000);
  EXPECT_NEAR(static_cast<double>(inner(right.load_events(), 0)), in_left, 1e-3 * in_left);
}

TEST_F(Rig, EveryCameraIsADatasetOfItsOwn) {
  simulate(config(std::string("rig: [{camera: {width: 40, height: 30}, ") + kRight + "}]\n"),
           output());
  const Dataset left = Dataset::open(output());
  const Dataset right = Dataset::open(output() / "cam1");
  EXPECT_EQ(right.camera().width, 40);
  EXPECT_EQ(right.facts().name, "out/cam1");
  EXPECT_TRUE(verify_hashes(output()).empty());
  EXPECT_TRUE(verify_hashes(output() / "cam1").empty());
  EXPECT_THAT(left.further_cameras(), ElementsAre(output() / "cam1"));
  EXPECT_TRUE(right.further_cameras().empty());
  EXPECT_TRUE(left.has_imu());
  EXPECT_FALSE(right.has_imu());
  EXPECT_EQ(right.load_twists().size(), right.groundtruth().size());
  for (std::size_t i = 0; i < left.groundtruth().size(); i += 10) {
    const Rigid3 a = left.groundtruth().poses()[i].world_from_camera;
    const Rigid3 b = right.groundtruth().poses()[i].world_from_camera;
    EXPECT_LT(((a.inverse() * b).translation() - Eigen::Vector3d(kBaseline_m, 0, 0)).norm(), 1e-12);
  }
  const std::vector<ChainCamera> chain = read_camera_chain(output() / "camera.yaml");
  ASSERT_EQ(chain.size(), 2U);
  EXPECT_EQ(chain[1].camera, right.camera());
  EXPECT_EQ(chain[1].camera_from_previous->translation(), Eigen::Vector3d(-kBaseline_m, 0, 0));
  EXPECT_EQ(read_camera_chain(output() / "cam1" / "camera.yaml").size(), 1U);
}

TEST_F(Rig, PicturesGoThroughTheToneCurve) {
  simulate(config("frames: {rate_hz: 10, gain: 0.5}\n"), output());
  const ImageF frame = Dataset::open(output()).load_frame(0);
  const ImageU8 picture = read_image_grey(output() / "images" / "frame_00000000.png");
  for (int x = 0; x < 61; ++x) {
    const float linear = std::min(0.5F * frame(x, 9), 1.0F);
    ASSERT_GT(linear, 0.0031308F);  // where sRGB is a power
    EXPECT_NEAR(picture(x, 9), 255 * (1.055F * std::pow(linear, 1 / 2.4F) - 0.055F), 0.51);
  }
}

TEST_F(Rig, RefusesWhatIsNoCamera) {
  const auto error = [&](const std::string& rig) {
    return error_of([&] { return rig_cameras(config(rig)); });
  };
  EXPECT_THAT(error("rig: [{camera: {width: 40}}]\n"), HasSubstr("T_camera0_camera"));
  EXPECT_THAT(error(std::string("rig: [{") + kRight + ", baseline: 3}]\n"),
              AllOf(HasSubstr("test.yaml:4"), HasSubstr("baseline")));
}

TEST(CameraChain, StatesTheTransformationsBetweenNeighboursAndFromTheImu) {
  const Rigid3 a(so3_exp({0, 0.1, 0}), {0.1, 0, 0});
  const Rigid3 b(so3_exp({0.2, 0, 0}), {0.1, 0.3, 0});
  const PinholeCamera camera{64, 48, 50, 50, 31.5, 23.5, {}};
  const std::vector<RigCamera> cameras = {
      {camera, {}, Rigid3(), 1, {}}, {camera, {}, a, 2, "cam1"}, {camera, {}, b, 3, "cam2"}};
  ImuOptions imu;
  imu.camera_from_imu = Rigid3(so3_exp({0, 0, 1}), {0, 0, 0.5});
  const std::vector<ChainCamera> chain = camera_chain(cameras, imu);
  ASSERT_EQ(chain.size(), 3U);
  EXPECT_FALSE(chain[0].camera_from_previous.has_value());
  // Along the chain from the first camera, and beside it from the IMU.
  const Rigid3 camera2_from_camera0 =
      *chain[2].camera_from_previous * *chain[1].camera_from_previous;
  EXPECT_LT((camera2_from_camera0 * b).log().norm(), 1e-12);
  EXPECT_LT((camera2_from_camera0 * *chain[0].camera_from_imu * chain[2].camera_from_imu->inverse())
                .log()
                .norm(),
            1e-12);
  imu.rate_hz = 0;
  EXPECT_FALSE(camera_chain(cameras, imu)[0].camera_from_imu.has_value());
}

}  // namespace
}  // namespace saccade
