#include "core/io/images/png_file.h"

#include <png.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <csetjmp>
#include <cstring>
#include <new>
#include <vector>

#include "core/error.h"
#include "core/io/images/picture_bytes.h"
#include "core/io/images/rgb_grey.h"

namespace saccade {
namespace {

/// Deflate makes at most 1032 bytes of one, so that what a header states can be compared with what
/// follows before memory is taken for it.
constexpr std::uint64_t kMostInflation = 1032;

struct PngHandles {
  png_structp png = nullptr;
  png_infop info = nullptr;
  PngHandles() = default;
  ~PngHandles() { png_destroy_read_struct(&png, &info, nullptr); }
  PngHandles(const PngHandles&) = delete;
  PngHandles& operator=(const PngHandles&) = delete;
};

/// libpng reports errors by a jump: no frame between holds what would have to be destroyed.
class PngReader {
 public:
  PngReader(std::span<const std::byte> bytes, const std::string& location)
      : bytes_(bytes), location_(location) {
    handles_.png = png_create_read_struct(PNG_LIBPNG_VER_STRING, this, on_error, on_warning);
    if (handles_.png == nullptr) throw std::bad_alloc();
    handles_.info = png_create_info_struct(png());
    if (handles_.info == nullptr) throw std::bad_alloc();
    png_set_read_fn(png(), this, read);
    png_set_user_limits(png(), kMostPictureSide, kMostPictureSide);
    if (!succeeds(&PngReader::read_header)) fail();
    check_picture_size(width(), height(), location_);
    const std::uint64_t bits = std::uint64_t{bit_depth()} * png_get_channels(png(), info());
    if (width() * height() * bits / 8 > kMostInflation * bytes_.size()) {
      message_ = {"it ends too early"};
      fail();
    }
  }
  PngReader(const PngReader&) = delete;
  PngReader& operator=(const PngReader&) = delete;

  [[nodiscard]] std::uint64_t width() const { return png_get_image_width(png(), info()); }
  [[nodiscard]] std::uint64_t height() const { return png_get_image_height(png(), info()); }
  [[nodiscard]] unsigned bit_depth() const { return png_get_bit_depth(png(), info()); }
  [[nodiscard]] int color_type() const { return png_get_color_type(png(), info()); }

  /// `convert` states libpng's conversions into `Pixel` and may be left by a jump.
  template <class Pixel>
  [[nodiscard]] Image<Pixel> pixels(void (*convert)(png_structp, png_infop)) {
    Image<Pixel> image(static_cast<int>(width()), static_cast<int>(height()));
    std::vector<png_bytep> rows(height());
    for (std::size_t y = 0; y < rows.size(); ++y)
      rows[y] = reinterpret_cast<png_bytep>(&image(0, static_cast<int>(y)));
    convert_ = convert;
    row_size_ = sizeof(Pixel) * width();
    rows_ = rows.data();
    if (!succeeds(&PngReader::read_rows)) fail();
    return image;
  }

 private:
  [[nodiscard]] png_structp png() const { return handles_.png; }
  [[nodiscard]] png_infop info() const { return handles_.info; }

  [[noreturn]] static void on_error(png_structp png, png_const_charp message) {
    auto& reader = *static_cast<PngReader*>(png_get_error_ptr(png));
    std::strncpy(reader.message_.data(), message, reader.message_.size() - 1);
    png_longjmp(png, 1);
  }
  static void on_warning(png_structp /*png*/, png_const_charp /*message*/) {}

  static void read(png_structp png, png_bytep out, std::size_t count) {
    auto& reader = *static_cast<PngReader*>(png_get_io_ptr(png));
    if (count > reader.bytes_.size() - reader.position_) png_error(png, "it ends too early");
    std::memcpy(out, reader.bytes_.data() + reader.position_, count);
    reader.position_ += count;
  }

  /// False where `step` ended in an error. Nothing but the call stands here, because what a function
  /// that is jumped into holds is lost.
  [[nodiscard]] bool succeeds(void (PngReader::*step)()) {
    if (setjmp(png_jmpbuf(png())) != 0) return false;
    (this->*step)();
    return true;
  }

  [[gnu::noinline]] void read_header() { png_read_info(png(), info()); }

  [[gnu::noinline]] void read_rows() {
    convert_(png(), info());
    png_set_interlace_handling(png());
    png_read_update_info(png(), info());
    if (png_get_rowbytes(png(), info()) != row_size_)
      png_error(png(), "its rows have another length");
    png_read_image(png(), rows_);
    png_read_end(png(), nullptr);
  }

  [[noreturn]] void fail() const {
    throw InputError(location_, std::string("is no PNG picture or is damaged: ") + message_.data());
  }

  std::span<const std::byte> bytes_;
  const std::string& location_;
  std::size_t position_ = 0;
  std::array<char, 160> message_{};
  PngHandles handles_;
  void (*convert_)(png_structp, png_infop) = nullptr;
  png_bytepp rows_ = nullptr;
  std::size_t row_size_ = 0;
};

void set_bytes_of_machine(png_structp png) {
  if constexpr (std::endian::native == std::endian::little) png_set_swap(png);
}

/// Of a grey picture.
void to_grey8(png_structp png, png_infop info) {
  png_set_strip_16(png);
  png_set_strip_alpha(png);
  if (png_get_color_type(png, info) == PNG_COLOR_TYPE_GRAY) png_set_expand_gray_1_2_4_to_8(png);
}

void to_rgb8(png_structp png, png_infop info) {
  png_set_strip_16(png);
  png_set_strip_alpha(png);
  png_set_palette_to_rgb(png);
  if (png_get_color_type(png, info) == PNG_COLOR_TYPE_GRAY) png_set_expand_gray_1_2_4_to_8(png);
  png_set_gray_to_rgb(png);
}

void to_rgba(png_structp png, png_infop /*info*/) {
  png_set_expand(png);  // palettes, fewer than 8 bits, transparent colours
  png_set_gray_to_rgb(png);
  png_set_add_alpha(png, 0xFFFF, PNG_FILLER_AFTER);
  set_bytes_of_machine(png);
}

void to_all_bits(png_structp png, png_infop /*info*/) { set_bytes_of_machine(png); }

}  // namespace

bool is_png(std::span<const std::byte> bytes) { return begins_with(bytes, "\x89PNG\r\n\x1A\n"); }

ImageU8 decode_png_grey(std::span<const std::byte> bytes, const std::string& location) {
  PngReader reader(bytes, location);
  // libpng would mix the colours of a file that states its gamma in linear light.
  if ((reader.color_type() & PNG_COLOR_MASK_COLOR) != 0)
    return grey_from(reader.pixels<Rgb8>(to_rgb8));
  return reader.pixels<std::uint8_t>(to_grey8);
}

ImageRgb8 decode_png_rgb(std::span<const std::byte> bytes, const std::string& location) {
  return PngReader(bytes, location).pixels<Rgb8>(to_rgb8);
}

ImageRgba8 decode_png_rgba(std::span<const std::byte> bytes, const std::string& location) {
  PngReader reader(bytes, location);
  if (reader.bit_depth() < 16) return reader.pixels<Rgba8>(to_rgba);
  const auto fine = reader.pixels<std::array<std::uint16_t, 4>>(to_rgba);
  ImageRgba8 image(fine.width(), fine.height());
  std::ranges::transform(
      fine.pixels(), image.data(), [](const std::array<std::uint16_t, 4>& codes) {
        Rgba8 pixel;
        for (std::size_t k = 0; k < codes.size(); ++k)
          pixel[k] = static_cast<std::uint8_t>(std::min(255L, std::lrint(codes[k] / 256.0)));
        return pixel;
      });
  return image;
}

ImageU16 decode_png_u16(std::span<const std::byte> bytes, const std::string& location) {
  PngReader reader(bytes, location);
  if (reader.bit_depth() != 16 || reader.color_type() != PNG_COLOR_TYPE_GRAY)
    throw InputError(location, "is no picture of one channel of 16 bits");
  return reader.pixels<std::uint16_t>(to_all_bits);
}

ImageRgb16 decode_png_rgb16(std::span<const std::byte> bytes, const std::string& location) {
  PngReader reader(bytes, location);
  if (reader.bit_depth() != 16 || reader.color_type() != PNG_COLOR_TYPE_RGB)
    throw InputError(location, "is no picture of three channels of 16 bits");
  return reader.pixels<Rgb16>(to_all_bits);
}

}  // namespace saccade
