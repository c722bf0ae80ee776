#include "eval/picture/render.h"

#include <gtest/gtest.h>

#include <cstdlib>

#include "core/error.h"
#include "core/io/image_file.h"
#include "eval/picture/video.h"
#include "tests/unit/eval/fake_folders.h"

namespace saccade {
namespace {

namespace fs = std::filesystem;
using testing::TemporaryFolder;

class Render : public testing::FakeFolders {
 protected:
  TemporaryFolder folder;
};

TEST_F(Render, ContactSheetsOfADatasetAndARun) {
  const fs::path picture = folder.path() / "sheet.png";
  render(dataset(), picture);
  EXPECT_GT(read_image_rgb(picture).width(), 3 * 3 * 80);
  render(run(), picture);
  EXPECT_GT(read_image_rgb(picture).height(), 4 * 3 * 60);
}

TEST_F(Render, OneMomentIsOneRow) {
  const fs::path picture = folder.path() / "moment.png";
  render(run(), picture, {.time_s = 0.1, .upscale = 2, .dark = false});
  const ImageRgb8 image = read_image_rgb(picture);
  EXPECT_GT(image.width(), 2 * 2 * 80);
  EXPECT_LT(image.height(), 2 * 2 * 60);
  EXPECT_EQ(image(0, 0), (Rgb8{255, 255, 255}));
}

TEST_F(Render, RefusesWhatItCannotDraw) {
  EXPECT_THROW(render(dataset(), folder.path() / "x.gif"), InputError);
  EXPECT_THROW(render(dataset(), folder.path() / "x.png", {.time_s = 9.0}), InputError);
  EXPECT_THROW(render(dataset(), folder.path() / "x.png", {.upscale = 0}), InputError);
  EXPECT_THROW(render(dataset(), folder.path() / "x.png", {.start_s = 5.0}), InputError);
  EXPECT_THROW(render(folder.path() / "nothing", folder.path() / "x.png"), InputError);
  EXPECT_TRUE(fs::is_empty(folder.path()));
}

TEST_F(Render, AVideoNeedsFfmpeg) {
  const std::string path = std::getenv("PATH");
  setenv("PATH", "/nowhere", 1);
  try {
    render(dataset(), folder.path() / "x.mp4");
    ADD_FAILURE() << "no error";
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("ffmpeg"), std::string::npos);
  }
  setenv("PATH", path.c_str(), 1);
  EXPECT_TRUE(fs::is_empty(folder.path()));
}

TEST_F(Render, AVideoOfARun) {
  if (std::system("ffmpeg -version > /dev/null 2>&1") != 0) GTEST_SKIP() << "ffmpeg is not here";
  const fs::path video = folder.path() / "run.mp4";
  render(run(), video, {.duration_s = 0.05, .upscale = 1, .slow_motion = 2});
  EXPECT_GT(fs::file_size(video), 1000U);
  EXPECT_EQ(std::distance(fs::directory_iterator(folder.path()), fs::directory_iterator()), 1);
}

TEST_F(Render, AnUnfinishedVideoLeavesNothing) {
  if (std::system("ffmpeg -version > /dev/null 2>&1") != 0) GTEST_SKIP() << "ffmpeg is not here";
  {
    VideoWriter video(folder.path() / "x.mp4", 32, 32, 30);
    video.add(ImageRgb8(32, 32));
  }
  EXPECT_TRUE(fs::is_empty(folder.path()));
}

}  // namespace
}  // namespace saccade
