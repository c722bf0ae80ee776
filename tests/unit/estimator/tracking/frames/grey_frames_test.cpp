#include "estimator/tracking/frames/grey_frames.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "core/io/images/exr_file.h"
#include "core/io/images/image_file.h"
#include "tests/support/command.h"
#include "tests/support/error_of.h"

namespace saccade {
namespace {

using testing::error_of;
using ::testing::HasSubstr;
using testing::TemporaryFolder;

/// Three frames of 40 x 30 pixels, each of one code.
class GreyFrames : public ::testing::Test {
 protected:
  GreyFrames() {
    folder_.write("calib.txt", "40 40 19.5 14.5 0 0 0 0 0\n");
    folder_.write("images.txt", "0 images/0.png\n0.04 images/1.png\n0.08 images/2.png\n");
    std::filesystem::create_directories(folder_.path() / "images");
    for (int i = 0; i < 3; ++i)
      write_png(folder_.path() / "images" / (std::to_string(i) + ".png"),
                ImageU8(40, 30, static_cast<std::uint8_t>(50 * (i + 1))));
  }
  void state(const std::string& frames) {
    folder_.write("dataset.yaml",
                  "format_version: 1\nwidth: 40\nheight: 30\nlog_eps: 0.01\nconfig: {frames: " +
                      frames + "}\n");
  }
  [[nodiscard]] Dataset dataset() const { return Dataset::open(folder_.path()); }

  TemporaryFolder folder_;
};

TEST(LogIntensityOfCodes, LeavesOutWhatIsBlackOrWhite) {
  ImageU8 codes(4, 1);
  codes(1, 0) = 1;
  codes(2, 0) = 254;
  codes(3, 0) = 255;
  const ImageF levels = log_intensity_of_codes(codes, {}, 1e-3);
  EXPECT_TRUE(std::isnan(levels(0, 0)));
  EXPECT_NEAR(levels(1, 0), std::log(1e-3 + 1 / 255.0 / 12.92), 1e-5);
  EXPECT_NEAR(levels(2, 0), std::log(1e-3 + linear_from_srgb(254 / 255.0)), 1e-5);
  EXPECT_TRUE(std::isnan(levels(3, 0)));
}

TEST_F(GreyFrames, AreThoseOfTheWindow) {
  const auto frames = load_grey_frames(dataset(), dataset().camera(), 0.04, 0.08);
  ASSERT_EQ(frames.size(), 2U);
  EXPECT_EQ(frames[0].t_ns, 40'000'000);
  EXPECT_NEAR(frames[0].log_intensity(7, 9), std::log(1e-3 + linear_from_srgb(100 / 255.0)), 1e-5);
  EXPECT_THAT(error_of([&] { return load_grey_frames(dataset(), dataset().camera(), 0.05, 0.07); }),
              HasSubstr("no frames in the window"));
}

TEST_F(GreyFrames, AreDecodedByTheToneCurveOfTheDataset) {
  state("{gain: 0.25, gamma: 2}");
  const auto frames = load_grey_frames(dataset(), dataset().camera(), 0, 0);
  ASSERT_EQ(frames.size(), 1U);
  EXPECT_NEAR(frames[0].log_intensity(3, 3), std::log(0.01 + 4 * std::pow(50 / 255.0, 2)), 1e-5);
  state("{gamma: rec709}");
  EXPECT_THAT(error_of([&] { return load_grey_frames(dataset(), dataset().camera(), 0, 0); }),
              HasSubstr("frames.gamma"));
}

TEST_F(GreyFrames, AreThePicturesNotTheRadianceBesideThem) {
  write_exr(folder_.path() / "images/0.exr", ImageF(40, 30, 0.9F), "Y");
  const auto frames = load_grey_frames(dataset(), dataset().camera(), 0, 0);
  EXPECT_NEAR(frames[0].log_intensity(3, 3), std::log(1e-3 + linear_from_srgb(50 / 255.0)), 1e-5);
}

TEST_F(GreyFrames, NameTheFileThatIsNoFrame) {
  folder_.write("images.txt", "0 images/0.png\n0.04 images/a.exr\n");
  write_exr(folder_.path() / "images/a.exr", ImageF(40, 30, 0.9F), "Y");
  EXPECT_THAT(error_of([&] { return load_grey_frames(dataset(), dataset().camera(), 0, 1); }),
              HasSubstr("a.exr"));
  folder_.write("images.txt", "0 images/0.png\n0.04 images/1.png\n");
  write_png(folder_.path() / "images/1.png", ImageU8(30, 40, 9));
  EXPECT_THAT(error_of([&] { return load_grey_frames(dataset(), dataset().camera(), 0, 1); }),
              HasSubstr("30 x 40"));
}

}  // namespace
}  // namespace saccade
