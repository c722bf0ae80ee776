// The colours of a scene in frames, and through a colour filter.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "core/config/config.h"
#include "core/io/dataset/dataset.h"
#include "core/io/images/exr_file.h"
#include "core/io/images/image_file.h"
#include "core/process/progress.h"
#include "core/srgb.h"
#include "simulator/scene/build_scene.h"
#include "simulator/simulate.h"
#include "tests/support/error_of.h"
#include "tests/unit/simulator/scene/mesh_files.h"
#include "tests/unit/simulator/scene/plane_scene.h"

namespace saccade {
namespace {

using ::testing::HasSubstr;

/// A red, a green, a blue and a picture of a patch side by side before the camera.
class ColouredScene : public testing::MeshFiles {
 protected:
  void SetUp() override {
    MeshFiles::SetUp();
    set_progress_quiet(true);
    ImageRgb8 picture(2, 2);
    picture.fill({200, 100, 50});
    write_png(folder_ / "patch.png", picture);
    write("patch.mtl",
          "newmtl red\nKd 0.8 0 0\nnewmtl green\nKd 0 0.6 0\nnewmtl blue\nKd 0 0 0.9\n"
          "newmtl picture\nmap_Kd patch.png\n");
    std::string text = "mtllib patch.mtl\nvt 0 0\nvt 1 0\nvt 1 1\n";
    const char* const names[] = {"red", "green", "blue", "picture"};
    for (int k = 0; k < 4; ++k) {
      const int x = k - 2;
      for (const auto& [dx, y] : {std::pair{0, -9}, {1, -9}, {1, 9}, {0, 9}})
        text += "v " + std::to_string(x + dx) + " " + std::to_string(y) + " 4\n";
      const auto corner = [&](int i) { return std::to_string(4 * k + i); };
      text += "usemtl " + std::string(names[k]) + "\nf " + corner(1) + "/1 " + corner(2) + "/2 " +
              corner(3) + "/3\nf " + corner(1) + "/1 " + corner(3) + "/3 " + corner(4) + "/2\n";
    }
    write("patch.obj", text);
  }
  void TearDown() override {
    set_progress_quiet(false);
    MeshFiles::TearDown();
  }

  /// 10 px for each patch.
  [[nodiscard]] SimulationConfig config(const std::string& more) const {
    return config::read<SimulationConfig>(
        config::parse("scene: {meshes: [{file: patch.obj}], background: 0.1}\n"
                      "trajectory:\n  source: waypoints\n  waypoints:\n"
                      "    - [0, 0, 0, 0, 0, 0, 0, 1]\n    - [0.1, 0.2, 0, 0, 0, 0, 0, 1]\n"
                      "camera: {width: 40, height: 6, fx: 40, fy: 40}\n" +
                          more,
                      "test.yaml", folder_));
  }

  /// The linear light of a column in a frame at time 0, in channel 0, 1 or 2.
  static double light(int x, int channel) {
    const int patch = x / 10;
    if (patch == 3) {
      const std::uint8_t codes[] = {200, 100, 50};
      return static_cast<double>(linear_from_srgb8(codes[channel]));
    }
    const double colours[] = {0.8, 0.6, 0.9};
    return patch == channel ? linear_from_srgb(colours[channel]) : 0;
  }
  static int channel_of(int x, int y) { return x % 2 + y % 2; }
};

TEST_F(ColouredScene, EachChannelHasItsLight) {
  const ColourChannel channels[] = {ColourChannel::kRed, ColourChannel::kGreen,
                                    ColourChannel::kBlue};
  for (int c = 0; c < 3; ++c) {
    const Scene scene = build_scene(config("").scene, channels[c]);
    for (int x = 5; x < 40; x += 10)
      EXPECT_NEAR(testing::see(scene, {{0, 0, 0}, {(x - 19.5) / 40, 0.01, 1}}).radiance,
                  light(x, c), 1e-6)
          << c << " " << x;
    EXPECT_EQ(testing::see(scene, {{0, 0, 0}, {1, 0, 1}}).radiance, 0.1);
  }
}

TEST_F(ColouredScene, FramesShowThreePlanes) {
  simulate(config("frames: {rate_hz: 10, colour: rgb, gain: 0.8}\n"), folder_ / "out");
  const ImageRgbF exr = read_exr_rgb(folder_ / "out/images/frame_00000000.exr");
  const ImageRgb8 png = read_image_rgb(folder_ / "out/images/frame_00000000.png");
  for (int y = 0; y < 6; ++y)
    for (int x = 0; x < 40; ++x)
      for (int c = 0; c < 3; ++c) {
        const auto channel = static_cast<std::size_t>(c);
        EXPECT_NEAR(exr(x, y)[channel], light(x, c), 1e-6);
        EXPECT_NEAR(png(x, y)[channel], srgb8_from_linear(static_cast<float>(0.8 * light(x, c))),
                    1);
      }
  // Who asks for one plane gets the luminance.
  const ImageF grey = Dataset::open(folder_ / "out").load_frame(0);
  EXPECT_NEAR(grey(15, 2), 0.7152 * light(15, 1), 1e-6);
}

TEST_F(ColouredScene, FramesShowTheMosaic) {
  for (const char* more : {"", ", readout_s: 1e-5", ", exposure_s: 1e-5"}) {
    simulate(config("frames: {rate_hz: 10, colour: rggb" + std::string(more) + "}\n"),
             folder_ / "out");
    const ImageF mosaic = Dataset::open(folder_ / "out").load_frame(0);
    ASSERT_EQ(mosaic.width(), 40);
    for (int y = 0; y < 6; ++y)
      for (int x = 1; x < 40; ++x)
        if (x % 10 != 0 && x % 10 != 9) {  // next to an edge
          EXPECT_NEAR(mosaic(x, y), light(x, channel_of(x, y)), 1e-6) << x << " " << y << more;
        }
  }
}

// Between red and green the red pixels turn dark or bright where a green one does the opposite.
TEST_F(ColouredScene, EventsHaveThePolarityOfTheirColour) {
  simulate(config("events: {colour_filter: rggb}\ngroundtruth: {event_labels: true}\n"),
           folder_ / "out");
  const Dataset dataset = Dataset::open(folder_ / "out");
  const Events events = dataset.load_events();
  std::size_t found = 0;
  for (const Event& event : events) {
    if (event.x < 8 || event.x > 11) continue;  // 2 px to the left of the edge at x = 9.5
    const int channel = channel_of(event.x, event.y);
    ASSERT_NE(channel, 2);
    EXPECT_EQ(event.polarity, channel == 1 ? 1 : -1);
    ++found;
  }
  EXPECT_GT(found, 20U);
  EXPECT_EQ(dataset.load_labels().size(), events.size());
}

TEST_F(ColouredScene, KeysAreReadAndMalformedOnesAreErrors) {
  const SimulationConfig read = config("events: {colour_filter: rggb}\nframes: {colour: rgb}\n");
  EXPECT_EQ(read.events.colour_filter, ColourFilter::kRggb);
  EXPECT_EQ(read.frames.colour, FrameOptions::Colour::kRgb);
  const auto error = [&](const std::string& more) {
    return testing::error_of([&] { static_cast<void>(config(more)); });
  };
  EXPECT_THAT(error("events: {colour_filter: bggr}\n"), HasSubstr("rggb"));
  EXPECT_THAT(error("frames: {colour: color}\n"), HasSubstr("rgb"));
}

}  // namespace
}  // namespace saccade
