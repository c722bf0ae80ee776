#include <png.h>

#include <array>
#include <bit>
#include <cstdint>
#include <string>
#include <vector>

#include "core/check.h"
#include "core/io/files/atomic_file.h"
#include "core/io/images/image_file.h"

namespace saccade {
namespace {

void append_png_bytes(png_structp png, png_bytep bytes, std::size_t count) {
  auto& file = *static_cast<std::string*>(png_get_io_ptr(png));
  file.append(reinterpret_cast<const char*>(bytes), count);
}

/// Fast rather than small: a deflate that looks for runs only, after differences along the rows.
void set_png_speed(png_structp png) {
  constexpr int kFastest = 1;
  constexpr int kRunsOnly = 3;
  png_set_filter(png, PNG_FILTER_TYPE_BASE, PNG_FILTER_SUB);
  png_set_compression_level(png, kFastest);
  png_set_compression_strategy(png, kRunsOnly);
}

/// Writing to memory a picture that is there fails only where memory ends: libpng then aborts.
template <class Pixel>
std::string encode_png_as(const Image<Pixel>& image, int bit_depth, int color_type) {
  SACCADE_CHECK(!image.empty());
  std::string file;
  png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, nullptr, nullptr, nullptr);
  SACCADE_CHECK(png != nullptr);
  png_infop info = png_create_info_struct(png);
  SACCADE_CHECK(info != nullptr);
  png_set_write_fn(png, &file, append_png_bytes, nullptr);
  set_png_speed(png);
  png_set_IHDR(png, info, static_cast<png_uint_32>(image.width()),
               static_cast<png_uint_32>(image.height()), bit_depth, color_type, PNG_INTERLACE_NONE,
               PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
  png_write_info(png, info);
  if (bit_depth == 16 && std::endian::native == std::endian::little) png_set_swap(png);
  for (int y = 0; y < image.height(); ++y)
    png_write_row(png, reinterpret_cast<png_const_bytep>(
                           image.data() +
                           static_cast<std::size_t>(y) * static_cast<std::size_t>(image.width())));
  png_write_end(png, info);
  png_destroy_write_struct(&png, &info);
  return file;
}

}  // namespace

std::string encode_png(const ImageU8& image) {
  return encode_png_as(image, 8, PNG_COLOR_TYPE_GRAY);
}

std::string encode_png(const ImageU16& image) {
  return encode_png_as(image, 16, PNG_COLOR_TYPE_GRAY);
}

std::string encode_png(const ImageRgb8& image) {
  return encode_png_as(image, 8, PNG_COLOR_TYPE_RGB);
}

std::string encode_png(const ImageRgb16& image) {
  return encode_png_as(image, 16, PNG_COLOR_TYPE_RGB);
}

std::string encode_png(const ImageRgba8& image) {
  return encode_png_as(image, 8, PNG_COLOR_TYPE_RGBA);
}

}  // namespace saccade
