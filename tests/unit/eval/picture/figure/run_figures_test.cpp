#include "eval/picture/figure/run_figures.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <string>

#include "core/io/images/exr_file.h"
#include "core/io/images/image_file.h"
#include "eval/picture/render.h"
#include "tests/support/error_of.h"
#include "tests/unit/eval/fake_folders.h"

namespace saccade {
namespace {

namespace fs = std::filesystem;
using ::testing::AllOf;
using testing::error_of;
using ::testing::HasSubstr;
using testing::TemporaryFolder;

class RunFigures : public testing::FakeFolders {
 protected:
  [[nodiscard]] fs::path copy_of_run() const {
    const fs::path copy = folder.path() / "run";
    fs::copy(run(), copy, fs::copy_options::recursive);
    return copy;
  }
  [[nodiscard]] ImageRgb8 draw(const fs::path& of, const std::string& name) const {
    const fs::path picture = folder.path() / "figure.png";
    render(of, picture, {.upscale = 2, .dark = false, .figure = name});
    return read_image_rgb(picture);
  }
  [[nodiscard]] std::string error(const fs::path& of, const std::string& name) const {
    return error_of([&] { return draw(of, name); });
  }

  TemporaryFolder folder;
};

TEST_F(RunFigures, ErrorsStandBesideThePath) {
  const ImageRgb8 image = draw(run(), "trajectory");
  EXPECT_GT(image.width(), 1100);
  const auto count = std::count(image.pixels().begin(), image.pixels().end(), kLightTheme.estimate);
  EXPECT_GT(count, 20) << "the estimate is drawn, mostly mixed with what is behind its thin line";
}

TEST_F(RunFigures, StagesOfTrackingAreReadFromTheRun) {
  const fs::path tracked = copy_of_run();
  fs::create_directories(tracked / "figures");
  ImageF half(80, 60);
  for (int y = 0; y < 60; ++y)
    for (int x = 0; x < 40; ++x) half(x, y) = 1;
  std::vector<ExrChannel> channels;
  for (const char* name : {"L", "gradient", "map", "mask", "mask_depth", "template", "events",
                           "template_depth", "dense", "semi_dense", "sparse_patches", "random"})
    channels.push_back({name, half});
  write_exr(tracked / "figures" / "tracking.exr", channels);
  const ImageRgb8 image = draw(tracked, "tracking");
  EXPECT_GT(image.width(), 4 * 2 * 80);
  EXPECT_GT(image.height(), 4 * 2 * 60);
  const auto chosen = std::count(image.pixels().begin(), image.pixels().end(), kLightTheme.on);
  EXPECT_EQ(chosen, 4 * 4 * 40 * 60) << "every selection, on 2 x 2 screen pixels";
  channels.pop_back();
  write_exr(tracked / "figures" / "tracking.exr", channels);
  EXPECT_THAT(error(tracked, "tracking"), HasSubstr("lacks the channel random"));
}

TEST_F(RunFigures, PicturesOfAGrowingImageStandInARow) {
  const fs::path grown = copy_of_run();
  fs::create_directories(grown / "growth");
  for (const char* name : {"growth_2000.png", "growth_10000.png"})
    write_png(grown / "growth" / name, ImageRgb8(80, 60));
  EXPECT_GT(draw(grown, "growth").width(), 2 * 80);
}

TEST_F(RunFigures, ARunThatLacksWhatAFigureNeedsIsAnErrorThatSaysSo) {
  for (const RunFigure& figure : run_figures()) {
    if (figure.name == "trajectory") continue;
    EXPECT_THAT(error(run(), std::string(figure.name)), HasSubstr(std::string(figure.needs)));
  }
  EXPECT_THAT(error(dataset(), "trajectory"), HasSubstr("is a dataset"));
  EXPECT_THAT(error(run(), "trajectry"), AllOf(HasSubstr("--figure"), HasSubstr("'trajectory'")));
  EXPECT_THAT(error_of([&] {
                render(run(), folder.path() / "x.mp4", {.figure = "trajectory"});
                return 0;
              }),
              HasSubstr(".png"));
}

}  // namespace
}  // namespace saccade
