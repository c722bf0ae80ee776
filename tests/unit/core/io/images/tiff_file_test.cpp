#include "core/io/images/tiff_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <tiffio.h>

#include <vector>

#include "core/io/files/file_bytes.h"
#include "tests/support/command.h"
#include "tests/support/damage.h"
#include "tests/support/error_of.h"

namespace saccade {
namespace {

using ::testing::AnyOf;
using testing::error_of;
using ::testing::HasSubstr;

constexpr std::uint32_t kTiffWidth = 9, kTiffHeight = 5;

class TiffFiles : public ::testing::Test {
 protected:
  /// Rows of the codes 0, 1, 2 ... per sample.
  [[nodiscard]] std::string file_of(int samples, int bits, int compression) const {
    const auto path = folder_.path() / "a.tiff";
    TIFF* tiff = TIFFOpen(path.c_str(), "w");
    TIFFSetField(tiff, TIFFTAG_IMAGEWIDTH, kTiffWidth);
    TIFFSetField(tiff, TIFFTAG_IMAGELENGTH, kTiffHeight);
    TIFFSetField(tiff, TIFFTAG_SAMPLESPERPIXEL, samples);
    TIFFSetField(tiff, TIFFTAG_BITSPERSAMPLE, bits);
    TIFFSetField(tiff, TIFFTAG_COMPRESSION, compression);
    TIFFSetField(tiff, TIFFTAG_PLANARCONFIG, PLANARCONFIG_CONTIG);
    TIFFSetField(tiff, TIFFTAG_PHOTOMETRIC, samples < 3 ? PHOTOMETRIC_MINISBLACK : PHOTOMETRIC_RGB);
    TIFFSetField(tiff, TIFFTAG_ROWSPERSTRIP, 2);
    std::vector<std::uint8_t> row(kTiffWidth * static_cast<unsigned>(samples * bits / 8));
    for (std::uint32_t y = 0; y < kTiffHeight; ++y) {
      for (std::size_t i = 0; i < row.size(); ++i)
        row[i] = static_cast<std::uint8_t>(bits == 8 ? i : i / 2);
      TIFFWriteScanline(tiff, row.data(), y, 0);
    }
    TIFFClose(tiff);
    const std::vector<std::byte> bytes = read_file_bytes(path);
    return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
  }

  testing::TemporaryFolder folder_;
};

ImageRgba8 tiff_rgba(const std::string& file) {
  return decode_tiff(std::as_bytes(std::span(file)), "a.tiff");
}

TEST_F(TiffFiles, GreyAndColourInUsualCompressions) {
  for (const int compression :
       {COMPRESSION_NONE, COMPRESSION_LZW, COMPRESSION_ADOBE_DEFLATE, COMPRESSION_PACKBITS})
    for (const int bits : {8, 16}) {
      const ImageRgba8 grey = tiff_rgba(file_of(1, bits, compression));
      ASSERT_EQ(grey.width(), 9);
      ASSERT_EQ(grey.height(), 5);
      EXPECT_EQ(grey(7, 4), (Rgba8{7, 7, 7, 255})) << compression << " " << bits;
      EXPECT_EQ(tiff_rgba(file_of(3, bits, compression))(7, 4), (Rgba8{21, 22, 23, 255}));
    }
}

TEST_F(TiffFiles, DamageIsAnError) {
  for (const int compression : {COMPRESSION_NONE, COMPRESSION_LZW}) {
    const std::string file = file_of(1, 8, compression);
    testing::expect_damage_is_reported(file, file.size() / 2, tiff_rgba);
    EXPECT_THAT(error_of([&] { return tiff_rgba(file.substr(0, 20)); }),
                HasSubstr("a.tiff: is no TIFF"));
  }
}

TEST_F(TiffFiles, AHeaderThatStatesTooManyRowsIsAnError) {
  std::string file = file_of(1, 8, COMPRESSION_NONE);
  const std::string height("\1\1\3\0\1\0\0\0\5\0\0\0", 12);  // tag 257, one short number: 5
  ASSERT_NE(file.find(height), std::string::npos);
  file.replace(file.find(height), height.size(), std::string("\1\1\4\0\1\0\0\0\0\0\0\x70", 12));
  // libtiff sees by itself that its strips are too few, as far as it is told how many rows they have.
  EXPECT_THAT(error_of([&] { return tiff_rgba(file); }),
              AnyOf(HasSubstr("a.tiff: is a picture of 9 x 1879048192"),
                    HasSubstr("a.tiff: is no TIFF picture that can be decoded, or is damaged")));
}

}  // namespace
}  // namespace saccade
