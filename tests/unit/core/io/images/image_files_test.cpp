#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <ImfArray.h>
#include <ImfRgbaFile.h>

#include "core/io/files/file_bytes.h"
#include "core/io/images/exr_file.h"
#include "core/io/images/image_file.h"
#include "core/random.h"
#include "tests/support/command.h"
#include "tests/support/error_of.h"

namespace saccade {
namespace {

namespace fs = std::filesystem;
using testing::error_of;
using ::testing::HasSubstr;
using testing::TemporaryFolder;

ImageU8 grey_noise(int width, int height) {
  ImageU8 image(width, height);
  for (std::size_t i = 0; i < image.size(); ++i)
    image.pixels()[i] = static_cast<std::uint8_t>(Random(1).below(256, 0, i));
  return image;
}

ImageF float_noise(int width, int height, std::uint64_t stream) {
  ImageF image(width, height);
  for (std::size_t i = 0; i < image.size(); ++i)
    image.pixels()[i] = static_cast<float>(Random(1).normal(stream, i));
  return image;
}

class ImageFiles : public ::testing::Test {
 protected:
  TemporaryFolder folder_;
  const fs::path png_ = folder_.path() / "image.png";
  const fs::path exr_ = folder_.path() / "image.exr";
};

TEST_F(ImageFiles, GreyPngRoundTrip) {
  const ImageU8 image = grey_noise(17, 5);
  write_png(png_, image);
  EXPECT_EQ(read_image_grey(png_), image);
  const ImageRgb8 rgb = read_image_rgb(png_);
  EXPECT_EQ(rgb(3, 2), (Rgb8{image(3, 2), image(3, 2), image(3, 2)}));
}

TEST_F(ImageFiles, RgbPngRoundTripKeepsTheChannels) {
  ImageRgb8 image(4, 3, {0, 0, 0});
  image(1, 2) = {255, 128, 3};
  write_png(png_, image);
  EXPECT_EQ(read_image_rgb(png_), image);
  EXPECT_EQ(read_image_rgba(png_)(1, 2), (Rgba8{255, 128, 3, 255}));
  const std::vector<std::byte> bytes = read_file_bytes(png_);
  EXPECT_EQ(decode_image_rgba(bytes, "memory"), read_image_rgba(png_));
}

TEST_F(ImageFiles, PictureErrorsNameThePath) {
  EXPECT_THAT(error_of([&] { return read_image_grey(png_); }),
              HasSubstr("image.png: no such file"));
  folder_.write("image.png", "no picture");
  EXPECT_THAT(error_of([&] { return read_image_grey(png_); }),
              HasSubstr("is no picture that can be decoded: PNG, JPEG, BMP, TIFF and WebP can"));
  folder_.write("image.png", "");
  EXPECT_THAT(error_of([&] { return read_image_rgb(png_); }), HasSubstr("is empty"));
  EXPECT_THAT(error_of([&] { return decode_image_rgba({}, "a.zip!/b.jpg"); }),
              HasSubstr("a.zip!/b.jpg"));
}

TEST_F(ImageFiles, ExrRoundTripIsBitExact) {
  ImageF image = float_noise(33, 21, 0);
  image(0, 0) = 1e-38F;
  image(1, 0) = 3e38F;
  write_exr(exr_, image, "Z");
  EXPECT_EQ(read_exr(exr_), image);
  EXPECT_EQ(read_exr_channels(exr_).front().name, "Z");
}

TEST_F(ImageFiles, ExrRgbAndLuminance) {
  ImageRgbF image(3, 2, RgbF{0.25F, 0.5F, 1.0F});
  image(2, 1) = {1, 2, 3};
  write_exr(exr_, image);
  EXPECT_EQ(read_exr_rgb(exr_), image);
  EXPECT_NEAR(read_exr(exr_)(2, 1), 0.2126 + 2 * 0.7152 + 3 * 0.0722, 1e-6);
  const std::vector<std::byte> bytes = read_file_bytes(exr_);
  EXPECT_EQ(decode_exr_rgb(bytes, "memory"), image);
}

TEST_F(ImageFiles, ExrFlowRoundTrip) {
  const FlowField flow{float_noise(9, 7, 1), float_noise(9, 7, 2)};
  write_exr_flow(exr_, flow);
  const FlowField read = read_exr_flow(exr_);
  EXPECT_EQ(read.u, flow.u);
  EXPECT_EQ(read.v, flow.v);
}

TEST_F(ImageFiles, ExrPrefersTheNamedPlane) {
  const ImageF y = float_noise(4, 4, 3);
  const ImageF other = float_noise(4, 4, 4);
  write_exr(exr_, std::vector<ExrChannel>{{"A", other}, {"Y", y}});
  EXPECT_EQ(read_exr(exr_), y);
  write_exr(exr_, std::vector<ExrChannel>{{"depth.V", other}});
  EXPECT_EQ(read_exr(exr_), other);
}

TEST_F(ImageFiles, ReadsHalfFloatsWithAWindowOffTheOrigin) {
  Imf::Array2D<Imf::Rgba> pixels(2, 3);
  for (int y = 0; y < 2; ++y)
    for (int x = 0; x < 3; ++x) pixels[y][x] = Imf::Rgba(static_cast<float>(10 * y + x), 0, 0, 1);
  const Imath::Box2i window(Imath::V2i(5, -1), Imath::V2i(7, 0));
  {
    Imf::RgbaOutputFile file(exr_.c_str(), window, window, Imf::WRITE_RGBA);
    file.setFrameBuffer(&pixels[0][0] - 5 + 3, 1, 3);
    file.writePixels(2);
  }
  const ImageRgbF image = read_exr_rgb(exr_);
  EXPECT_EQ(image.width(), 3);
  EXPECT_EQ(image.height(), 2);
  EXPECT_EQ(image(2, 1)[0], 12);
}

TEST_F(ImageFiles, ExrErrorsNameThePath) {
  EXPECT_THAT(error_of([&] { return read_exr(exr_); }), HasSubstr("image.exr: no such file"));
  write_exr(exr_, float_noise(64, 64, 5), "Y");
  fs::resize_file(exr_, fs::file_size(exr_) / 2);
  EXPECT_THAT(error_of([&] { return read_exr(exr_); }), HasSubstr("image.exr: is no OpenEXR"));
  folder_.write("image.exr", "no exr");
  EXPECT_THAT(error_of([&] { return read_exr(exr_); }), HasSubstr("image.exr: is no OpenEXR"));
  write_exr(exr_, std::vector<ExrChannel>{{"a", ImageF(2, 2)}, {"b", ImageF(2, 2)}});
  EXPECT_THAT(error_of([&] { return read_exr(exr_); }), HasSubstr("its channels are: a b"));
  EXPECT_THAT(error_of([&] { return read_exr_flow(exr_); }), HasSubstr("needs channels u and v"));
}

TEST_F(ImageFiles, AnExrThatClaimsMorePixelsThanItHoldsTakesNoMemory) {
  write_exr(exr_, ImageF(8, 6, 0.5F), "Y");
  const std::string file = testing::read_file(exr_);
  const std::size_t window =
      file.find("dataWindow") + std::string_view("dataWindow?box2i?size").size() + 2;
  for (const std::int32_t last : {50'000, 1'000'000, 2'000'000'000}) {
    std::string damaged = file;
    for (const std::size_t corner : {8U, 12U})
      damaged.replace(window + corner, sizeof last, reinterpret_cast<const char*>(&last),
                      sizeof last);
    const auto claimed = folder_.write("b.exr", damaged);
    EXPECT_THAT(error_of([&] { return read_exr(claimed); }),
                HasSubstr("b.exr: is no OpenEXR picture or is damaged"))
        << last;
  }
}

}  // namespace
}  // namespace saccade
