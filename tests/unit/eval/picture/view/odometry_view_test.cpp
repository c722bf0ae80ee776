#include "eval/picture/view/odometry_view.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>

#include "core/io/images/image_file.h"
#include "eval/report/sections/module_sections.h"
#include "tests/unit/eval/fake_folders.h"

namespace saccade {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;
using ::testing::StartsWith;

constexpr int kKeyframeWidth = 80, kKeyframeHeight = 60;
constexpr int kKeyframeUpscale =
    4;  // of pictures so wide that their captions fit into a line or two

class OdometryViewTest : public testing::FakeFolders {
 protected:
  void SetUp() override {
    fs::copy(run(), odometry, fs::copy_options::recursive);
    testing::add_fake_keyframes(odometry, 10);
  }

  testing::TemporaryFolder folder;
  fs::path odometry = folder.path() / "odometry";
};

std::ptrdiff_t count_of(const ImageRgb8& image, const Rgb8& colour) {
  return std::count(image.pixels().begin(), image.pixels().end(), colour);
}

TEST_F(OdometryViewTest, FourPicturesOfOneMoment) {
  const RunFolder run_folder = RunFolder::open(odometry);
  const Dataset data = run_folder.open_dataset();
  const KeyframeHistory history = KeyframeHistory::load(run_folder).value();
  const OdometryView view(run_folder, data, history, {0.1, 0.1}, {.upscale = kKeyframeUpscale});
  const std::vector<CaptionedPicture> pictures = view.pictures(0.1);
  ASSERT_EQ(pictures.size(), 4U);
  for (const CaptionedPicture& picture : pictures) {
    EXPECT_EQ(picture.image.width(), kKeyframeUpscale * kKeyframeWidth);
    EXPECT_EQ(picture.image.height(), kKeyframeUpscale * kKeyframeHeight);
  }
  EXPECT_THAT(pictures[1].caption, StartsWith("depth of keyframe 3, 0.080 s"));
  EXPECT_THAT(pictures[2].caption, StartsWith("image of keyframe 3"));
  EXPECT_THAT(pictures[3].caption, HasSubstr("error"));
  EXPECT_THAT(pictures[3].caption, HasSubstr("deg"));
}

TEST_F(OdometryViewTest, SheetsAndMoments) {
  const fs::path file = folder.path() / "sheet.png";
  render(odometry, file, {.upscale = kKeyframeUpscale});
  const ImageRgb8 sheet = read_image_rgb(file);
  EXPECT_GT(sheet.width(), 4 * kKeyframeUpscale * kKeyframeWidth);
  EXPECT_GT(sheet.height(), 4 * kKeyframeUpscale * kKeyframeHeight);
  render(odometry, file, {.time_s = 0.1, .upscale = kKeyframeUpscale});
  const ImageRgb8 moment = read_image_rgb(file);
  EXPECT_GT(moment.width(), 2 * kKeyframeUpscale * kKeyframeWidth);
  EXPECT_LT(moment.width(), 3 * kKeyframeUpscale * kKeyframeWidth);
  EXPECT_GT(moment.height(), 2 * kKeyframeUpscale * kKeyframeHeight);
  EXPECT_LT(moment.height(), 3 * kKeyframeUpscale * kKeyframeHeight);
}

TEST_F(OdometryViewTest, AFilmOfThem) {
  if (std::system("ffmpeg -version > /dev/null 2>&1") != 0) GTEST_SKIP() << "ffmpeg is not here";
  const fs::path video = folder.path() / "film.mp4";
  render(odometry, video, {.duration_s = 0.03, .upscale = 1, .slow_motion = 2});
  EXPECT_GT(fs::file_size(video), 1000U);
}

TEST_F(OdometryViewTest, TheReportShowsAtMostEightKeyframes) {
  RunData data;
  data.run = RunFolder::open(odometry);
  EXPECT_EQ(keyframe_section(data), "") << "without the dataset";
  data.data = data.run.open_dataset();
  data.input = score_input(data.run, *data.data);
  data.keyframes = KeyframeHistory::load(data.run);
  const std::string html = keyframe_section(data);
  const auto occurrences = [&](const std::string& text) {
    int count = 0;
    for (std::size_t at = 0; (at = html.find(text, at)) != std::string::npos; ++at) ++count;
    return count;
  };
  EXPECT_EQ(occurrences("alt=\"depth of a keyframe\""), 8);
  EXPECT_EQ(occurrences("alt=\"image of a keyframe\""), 8);
  EXPECT_EQ(occurrences("alt=\"path from above\""), 1);
  EXPECT_EQ(occurrences("<tr><td"), 10) << "all of them are in the table";
  EXPECT_THAT(html, HasSubstr("9: depth at 0.200 s"));
}

TEST(TopDownPath, TheEstimateGrowsTheTruthIsThereFromTheStart) {
  std::vector<StampedPose> poses;
  for (int i = 0; i <= 10; ++i)
    poses.push_back({0.1 * i, Rigid3(Eigen::Quaterniond::Identity(), {0.1 * i, 0, 5})});
  const Trajectory line(poses);
  const TopDownPath path(line, line, 400, 300, kDarkTheme);
  const ImageRgb8 half = path.draw(0.5, {});
  const ImageRgb8 whole = path.draw(1, {});
  EXPECT_GT(count_of(half, kDarkTheme.truth), 100);
  EXPECT_EQ(half(200, 150), kDarkTheme.estimate) << "the middle of the path";
  EXPECT_EQ(whole(200 + 166, 150), kDarkTheme.estimate) << "its end";
  EXPECT_EQ(half(200 + 166, 150), kDarkTheme.truth);
  EXPECT_EQ(path.draw(-1, {})(200, 150), kDarkTheme.truth) << "not yet begun";
  const Eigen::Vector3d mark(0.25, 0, 5);
  EXPECT_EQ(path.draw(1, std::span(&mark, 1))(200 - 83, 150), kDarkTheme.map);
}

TEST(TopDownPath, NothingAndAStandstillCanBeDrawn) {
  const TopDownPath nothing({}, {}, 40, 30, kDarkTheme);
  EXPECT_EQ(count_of(nothing.draw(0, {}), kDarkTheme.background), 40 * 30);
  const TopDownPath still(Trajectory({{0, Rigid3()}}), {}, 400, 300, kDarkTheme);
  EXPECT_EQ(still.draw(0, {}).width(), 400);
}

}  // namespace
}  // namespace saccade
