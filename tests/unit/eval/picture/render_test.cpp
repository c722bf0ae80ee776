#include "eval/picture/render.h"

#include <gtest/gtest.h>

#include <cstdlib>

#include "core/error.h"
#include "core/io/dataset/dataset.h"
#include "core/io/events/events_h5.h"
#include "core/io/events/stabilized_events.h"
#include "core/io/files/file_list.h"
#include "core/io/images/image_file.h"
#include "eval/picture/video_writer.h"
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

/// The events of the dataset, moved by a pixel, and its frames as they are.
fs::path stabilized_run(const fs::path& run, const fs::path& data, const fs::path& folder) {
  fs::copy(run, folder, fs::copy_options::recursive);
  const fs::path stabilized = folder / "stabilized";
  fs::create_directories(stabilized);
  const Dataset dataset = Dataset::open(data);
  Events events;
  StabilizedCoordinates coordinates;
  for (const Event& event : dataset.load_events()) {
    if (event.x + 1 >= dataset.camera().width) continue;
    coordinates.source_x.push_back(event.x);
    coordinates.source_y.push_back(event.y);
    coordinates.x.push_back(event.x + 1.25F);
    coordinates.y.push_back(event.y);
    events.push_back(event);
    ++events.back().x;
  }
  EventH5Writer writer(stabilized / "events.h5", TimestampUnit::kNanoseconds);
  writer.append(events);
  writer.close();
  StabilizedCoordinatesWriter places(stabilized / "places.h5");
  places.append(coordinates);
  places.close();
  write_stabilized_windows(stabilized / "windows.csv", {});
  write_file_list(stabilized / "images.txt", dataset.frames());
  return folder;
}

TEST_F(Render, FramesAndEventsBeforeAndAfterStabilization) {
  const fs::path run_folder = stabilized_run(run(), dataset(), folder.path() / "run");
  const fs::path picture = folder.path() / "stabilized.png";
  render(run_folder, picture, {.time_s = 0.1, .upscale = 2});
  const ImageRgb8 image = read_image_rgb(picture);
  EXPECT_GT(image.width(), 2 * 2 * 80);
  EXPECT_LT(image.width(), 3 * 2 * 80);
  EXPECT_GT(image.height(), 2 * 2 * 60);
  render(run_folder, picture, {.upscale = 2});
  EXPECT_GT(read_image_rgb(picture).height(), 6 * 2 * 60);
  fs::remove(run_folder / "stabilized" / "places.h5");
  EXPECT_THROW(render(run_folder, picture), InputError);
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
    VideoWriter video(folder.path() / "x.mp4", 32, 32, 30, 18);
    video.add(ImageRgb8(32, 32));
  }
  EXPECT_TRUE(fs::is_empty(folder.path()));
}

}  // namespace
}  // namespace saccade
