#include "eval/picture/overlay/overlay.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <utility>
#include <vector>

#include "core/io/files/atomic_file.h"
#include "core/io/images/image_file.h"
#include "core/rigid3.h"
#include "eval/metrics/trajectory/align.h"
#include "eval/picture/render.h"
#include "tests/support/error_of.h"
#include "tests/unit/eval/fake_folders.h"

namespace saccade {
namespace {

namespace fs = std::filesystem;
using testing::error_of;
using ::testing::HasSubstr;
using ::testing::Not;
using testing::TemporaryFolder;

/// A yellow picture over the fake run, which is lost from 0.1 s on.
class OverlayTest : public testing::FakeFolders {
 protected:
  OverlayTest() : data(Dataset::open(dataset())), tracked(RunFolder::open(run())) {
    write_png(options.picture, ImageRgb8(20, 10, {255, 255, 0}));
    for (PoseRow& row : *tracked.poses)
      if (row.t_s >= 0.1) row.status = "lost";
    map = tracked.load_map().positions;
  }

  [[nodiscard]] Overlay over_run() const { return {options, data, &tracked, map, 0}; }
  [[nodiscard]] Overlay over_data() const { return {options, data, nullptr, {}, 0}; }

  [[nodiscard]] static CaptionedPicture drawn(const Overlay& overlay, double t_s) {
    return overlay.over({"events", ImageRgb8(80, 60)}, t_s, 1, kDarkTheme);
  }
  [[nodiscard]] static int count_of(const ImageRgb8& image, const Rgb8& colour) {
    return static_cast<int>(std::count(image.pixels().begin(), image.pixels().end(), colour));
  }

  TemporaryFolder folder;
  Dataset data;
  RunFolder tracked;
  std::vector<Eigen::Vector3f> map;
  OverlayOptions options{.picture = folder.path() / "yellow.png"};
};

constexpr Rgb8 kYellow{255, 255, 0};

TEST_F(OverlayTest, HangsBeforeTheFirstCameraAQuarterOfTheViewWide) {
  const Overlay overlay = over_data();
  const ImageRgb8 image = drawn(overlay, 0).image;
  // 20 px by 10 px around the optical axis, nothing of it behind the scene.
  EXPECT_NEAR(count_of(image, kYellow), 200, 35);
  EXPECT_EQ(image(39, 29), kYellow);
  EXPECT_EQ(image(39, 20), Rgb8{});
  EXPECT_EQ(image(25, 29), Rgb8{});
  const Rigid3 camera_from_picture =
      data.groundtruth().at_clamped(0).inverse() * overlay.picture().world_from_picture;
  EXPECT_GT(camera_from_picture.translation().z(), 1);
  EXPECT_LT(camera_from_picture.translation().z(), 3);
  EXPECT_LT(camera_from_picture.translation().head<2>().norm(), 1e-9);
}

TEST_F(OverlayTest, TheMapTellsHowFarARunsSceneIs) {
  const Rigid3 world_from_camera = *tracked.trajectory->at(0.1);
  options.at_s = 0.1;
  map.assign(100, (world_from_camera * Eigen::Vector3d(0, 0, 0.5)).cast<float>());
  const Rigid3 camera_from_picture =
      world_from_camera.inverse() * over_run().picture().world_from_picture;
  EXPECT_NEAR(camera_from_picture.translation().z(), 0.97 * 0.5, 1e-6);
}

TEST_F(OverlayTest, PoseAndWidthAreTakenAsGiven) {
  options.world_from_picture = Rigid3(Eigen::Quaterniond::Identity(), {1, 2, 3});
  options.width_m = 0.7;
  const Overlay overlay = over_data();
  EXPECT_EQ(overlay.picture().world_from_picture.translation(), Eigen::Vector3d(1, 2, 3));
  EXPECT_EQ(overlay.picture().width_m, 0.7);
  EXPECT_DOUBLE_EQ(overlay.picture().height_m(), 0.35);
}

TEST_F(OverlayTest, WhatTheDepthMapsSeeNearerHidesIt) {
  const Rigid3 behind(Eigen::Quaterniond::Identity(), {0, 0, 30});
  options.world_from_picture = data.groundtruth().at_clamped(0) * behind;
  const CaptionedPicture hidden = drawn(over_data(), 0);
  EXPECT_EQ(count_of(hidden.image, kYellow), 0);
  EXPECT_THAT(hidden.caption, HasSubstr("(not visible)"));
  options.on_top = true;
  EXPECT_NEAR(count_of(drawn(over_data(), 0).image, kYellow), 200, 35);
}

TEST_F(OverlayTest, SaysWhosePoseItIs) {
  EXPECT_EQ(drawn(over_data(), 0).caption, "events, picture: true pose");
  EXPECT_EQ(drawn(over_run(), 0).caption, "events, picture: estimate");
}

TEST_F(OverlayTest, LostPosesShow) {
  const Overlay overlay = over_run();
  const CaptionedPicture held = drawn(overlay, 0.09);
  EXPECT_GT(count_of(held.image, kYellow), 0);
  EXPECT_THAT(held.caption, Not(HasSubstr("LOST")));
  const CaptionedPicture lost = drawn(overlay, 0.11);
  EXPECT_EQ(count_of(lost.image, kYellow), 0);
  EXPECT_GT(count_of(lost.image, kDarkTheme.off), 20);
  EXPECT_THAT(lost.caption, HasSubstr("LOST"));
}

TEST_F(OverlayTest, WithoutAPoseForLongItIsLost) {
  tracked.poses.reset();
  const Overlay overlay = over_run();
  EXPECT_THAT(drawn(overlay, 0.26).caption, Not(HasSubstr("LOST")));
  EXPECT_THAT(drawn(overlay, 0.3).caption, HasSubstr("LOST"));
}

TEST_F(OverlayTest, TheTruthIsAnOutline) {
  const ImageRgb8 without = drawn(over_run(), 0).image;
  options.truth = true;
  const CaptionedPicture with = drawn(over_run(), 0);
  int changed = 0;
  for (std::size_t i = 0; i < without.size(); ++i)
    if (with.image.pixels()[i] != without.pixels()[i]) ++changed;
  EXPECT_GT(changed, 40);
  EXPECT_EQ(with.image(40, 30), without(40, 30));
  EXPECT_THAT(with.caption, HasSubstr("outline: true pose"));
}

TEST_F(OverlayTest, TheTruthIsBroughtIntoTheWorldOfARunThatHasItsOwn) {
  options.truth = true;
  // A run that knows the truth, in its own world, three times as small and turned away.
  tracked.trajectory = data.groundtruth();
  const ImageRgb8 expected = drawn(over_run(), 0).image;
  const Similarity own_from_truth{1.0 / 3, {so3_exp({0.3, -1, 2}), {5, -7, 1}}};
  tracked.trajectory = own_from_truth * data.groundtruth();
  map = own_from_truth * map;
  write_atomically(run() / "start.yaml", "given: false\n");
  const ImageRgb8 image = drawn(over_run(), 0).image;
  int differ = 0;
  for (std::size_t i = 0; i < image.size(); ++i)
    if (image.pixels()[i] != expected.pixels()[i]) ++differ;
  EXPECT_LT(differ, 10);
  // Without a map the depth maps tell where the scene is, in metres.
  map.clear();
  EXPECT_EQ(count_of(drawn(over_run(), 0).image, kYellow), count_of(expected, kYellow));
}

TEST_F(OverlayTest, OfARunInAWorldOfItsOwnTheSceneHidesWhatIsBehindIt) {
  const Similarity own_from_truth{1.0 / 3, {so3_exp({0.3, -1, 2}), {5, -7, 1}}};
  tracked.trajectory = own_from_truth * data.groundtruth();
  write_atomically(run() / "start.yaml", "given: false\n");
  // A picture some metres behind the scene, which in units of the run is nearer than the scene's metres.
  const Rigid3 behind(Eigen::Quaterniond::Identity(), {0, 0, 6});
  options.world_from_picture = own_from_truth * (data.groundtruth().at_clamped(0) * behind);
  EXPECT_EQ(count_of(drawn(over_run(), 0).image, kYellow), 0);
  options.on_top = true;
  EXPECT_GT(count_of(drawn(over_run(), 0).image, kYellow), 100);
}

TEST_F(OverlayTest, WithoutACommonTimeThereIsNoTruthInAWorldOfItsOwn) {
  options.truth = true;
  std::vector<StampedPose> later;
  for (const StampedPose& pose : data.groundtruth().poses())
    later.push_back({pose.t_s + 100, pose.world_from_camera});
  tracked.trajectory = Trajectory(std::move(later));
  write_atomically(run() / "start.yaml", "given: false\n");
  EXPECT_THAT(error_of([&] { return over_run(); }),
              HasSubstr("no pose at a time of the ground truth"));
}

TEST_F(OverlayTest, SaysWhatIsMissing) {
  options.truth = true;
  EXPECT_THAT(error_of([&] { return over_data(); }), HasSubstr("--overlay-truth: applies to runs"));
  options.truth = false;
  options.at_s = 3;
  EXPECT_THAT(error_of([&] { return over_data(); }),
              HasSubstr("--overlay-at-s: 3 s is not within 0.000 .. 0.250 s"));
  options.at_s.reset();
  options.picture = folder.path() / "none.png";
  EXPECT_THAT(error_of([&] { return over_data(); }), HasSubstr("none.png: no such file"));
  options.picture = folder.write("text.png", "no picture");
  EXPECT_THAT(error_of([&] { return over_data(); }), HasSubstr("text.png: is no picture"));
  tracked.trajectory.reset();
  EXPECT_THAT(error_of([&] { return over_run(); }), HasSubstr("holds no pose"));
}

TEST_F(OverlayTest, IsPartOfSheetsMomentsAndVideos) {
  const fs::path picture = folder.path() / "sheet.png";
  render(dataset(), picture, {.upscale = 2, .overlay = options});
  EXPECT_GT(count_of(read_image_rgb(picture), kYellow), 8 * 100);
  render(run(), picture, {.time_s = 0.1, .upscale = 2, .overlay = options});
  EXPECT_GT(count_of(read_image_rgb(picture), kYellow), 2 * 100);
  EXPECT_LT(read_image_rgb(picture).height(), 2 * 2 * 60);
}

}  // namespace
}  // namespace saccade
