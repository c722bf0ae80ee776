// A picture that hangs in the world of a simulated and tracked recording, through a lens.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "core/io/dataset/dataset.h"
#include "core/io/images/image_file.h"
#include "tests/system/saccade_command.h"

namespace saccade::testing {
namespace {

namespace fs = std::filesystem;

constexpr Rgb8 kYellow{255, 255, 0};

/// Walls through a lens, simulated and tracked once for all tests.
class OverlayOfARun : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder_ = std::make_unique<TemporaryFolder>();
    write_png(yellow(), ImageRgb8(64, 64, kYellow));
    saccade_ok({"simulate", shipped_config("simulation/walls.yaml"), "-o", data(), "--set",
                "duration_s=0.15", "--set", "camera.distortion=[-0.3, 0.1, 0.001, -0.001, 0]"});
    saccade_ok({"run", "track", "--data", data(), "-o", run(), "-c",
                shipped_config("tracking/accurate.yaml")});
  }
  static void TearDownTestSuite() { folder_.reset(); }

  [[nodiscard]] static std::string at(const std::string& name) { return folder_->path() / name; }
  [[nodiscard]] static std::string data() { return at("walls"); }
  [[nodiscard]] static std::string run() { return at("run"); }
  [[nodiscard]] static std::string yellow() { return at("yellow.png"); }

  /// One moment with the picture in it.
  [[nodiscard]] static ImageRgb8 rendered(const std::string& path,
                                          const std::vector<std::string>& more) {
    const std::string png = at("moment.png");
    std::vector<std::string> arguments = {"render",    path,     "-o",     png,
                                          "--overlay", yellow(), "--time", "0.1"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    saccade_ok(arguments);
    return read_image_rgb(png);
  }

  /// Mean position of the yellow pixels of the events, which fill the sheet's left half.
  struct Patch {
    Eigen::Vector2d middle = Eigen::Vector2d::Zero();
    double count = 0;
  };
  [[nodiscard]] static Patch left_patch(const ImageRgb8& sheet) {
    Patch patch;
    for (int y = 0; y < sheet.height(); ++y)
      for (int x = 0; x < sheet.width() / 2; ++x)
        if (sheet(x, y) == kYellow) {
          patch.middle += Eigen::Vector2d(x, y);
          ++patch.count;
        }
    patch.middle /= std::max(1.0, patch.count);
    return patch;
  }

 private:
  static inline std::unique_ptr<TemporaryFolder> folder_;
};

TEST_F(OverlayOfARun, EstimateAndTruthPutItAtTheSamePlace) {
  // 3 m before the first camera, in the world, for both.
  const Rigid3 first = Dataset::open(data()).groundtruth().at_clamped(0);
  const Eigen::Vector3d t = first * Eigen::Vector3d(0, 0, 3);
  const Eigen::Quaterniond& q = first.rotation();
  const std::vector<std::string> place = {
      "--overlay-pose",
      fmt::format("{} {} {} {} {} {} {}", t.x(), t.y(), t.z(), q.x(), q.y(), q.z(), q.w()),
      "--overlay-width", "0.8", "--overlay-on-top"};
  const Patch estimate = left_patch(rendered(run(), place));
  const Patch truth = left_patch(rendered(data(), place));
  EXPECT_GT(estimate.count, 1000);
  EXPECT_NEAR(estimate.count / truth.count, 1, 0.1);
  EXPECT_LT((estimate.middle - truth.middle).norm(), 3 * 2);  // 2 px of the sensor
}

TEST_F(OverlayOfARun, TheTruthIsOutlined) {
  const ImageRgb8 without = rendered(run(), {});
  EXPECT_GT(left_patch(without).count, 1000);
  const ImageRgb8 with = rendered(run(), {"--overlay-truth"});
  EXPECT_NE(with, without);
}

TEST_F(OverlayOfARun, SheetsAndVideos) {
  saccade_ok({"render", run(), "-o", at("sheet.png"), "--overlay", yellow()});
  EXPECT_GT(left_patch(read_image_rgb(at("sheet.png"))).count, 4000);
  if (!on_search_path("ffmpeg")) return;
  saccade_ok({"render", run(), "-o", at("run.mp4"), "--overlay", yellow(), "--upscale", "1",
              "--slow-motion", "2"});
  EXPECT_EQ(read_file(at("run.mp4")).substr(4, 4), "ftyp");
}

}  // namespace
}  // namespace saccade::testing
