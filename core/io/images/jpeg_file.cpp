#include "core/io/images/jpeg_file.h"

#include <array>
#include <csetjmp>
#include <cstdint>
#include <cstdio>  // which jpeglib.h needs before it

#include <jpeglib.h>

#include <jerror.h>

#include "core/error.h"
#include "core/io/images/picture_bytes.h"
#include "core/io/images/rgb_grey.h"

namespace saccade {
namespace {

using Cmyk8 = std::array<std::uint8_t, 4>;

struct JpegErrors {
  jpeg_error_mgr manager{};  ///< first, so that a pointer to it is one to the whole
  std::jmp_buf jump{};
  std::array<char, JMSG_LENGTH_MAX> message{};
  bool ends_early = false, lacks_data = false;
};

/// libjpeg reports errors by a jump: no frame between holds what would have to be destroyed.
class JpegReader {
 public:
  JpegReader(std::span<const std::byte> bytes, const std::string& location)
      : bytes_(bytes), location_(location) {
    state_.err = jpeg_std_error(&errors_.manager);
    errors_.manager.error_exit = on_error;
    errors_.manager.emit_message = on_message;
  }
  ~JpegReader() { jpeg_destroy_decompress(&state_); }
  JpegReader(const JpegReader&) = delete;
  JpegReader& operator=(const JpegReader&) = delete;

  void begin() {
    if (!succeeds(&JpegReader::read_header)) fail();
    check_picture_size(state_.image_width, state_.image_height, bytes_.size(), location_);
  }
  [[nodiscard]] bool is_cmyk() const { return state_.num_components == 4; }

  /// `space`: one of libjpeg's of as many components as `Pixel` has.
  template <class Pixel>
  [[nodiscard]] Image<Pixel> pixels(J_COLOR_SPACE space) {
    Image<Pixel> image(static_cast<int>(state_.image_width), static_cast<int>(state_.image_height));
    state_.out_color_space = space;
    rows_ = reinterpret_cast<JSAMPROW>(image.data());
    row_size_ = sizeof(Pixel) * state_.image_width;
    if (!succeeds(&JpegReader::read_rows)) fail();
    // What is missing was filled in with grey; a mark of the end alone is not missed.
    if (errors_.ends_early && (errors_.lacks_data || has_multiple_scans_))
      throw InputError(location_, "is a damaged JPEG picture: it ends too early");
    return image;
  }

 private:
  [[noreturn]] static void on_error(j_common_ptr state) {
    auto& errors = *reinterpret_cast<JpegErrors*>(state->err);
    state->err->format_message(state, errors.message.data());
    std::longjmp(errors.jump, 1);
  }
  /// Other warnings than those of the end are of what many programs write, and readers forgive.
  static void on_message(j_common_ptr state, int level) {
    if (level >= 0) return;
    auto& errors = *reinterpret_cast<JpegErrors*>(state->err);
    if (state->err->msg_code == JWRN_JPEG_EOF) errors.ends_early = true;
    if (state->err->msg_code == JWRN_HIT_MARKER) errors.lacks_data = true;
  }

  /// False where `step` ended in an error. Nothing but the call stands here, because what a function
  /// that is jumped into holds is lost.
  [[nodiscard]] bool succeeds(void (JpegReader::*step)()) {
    if (setjmp(errors_.jump) != 0) return false;
    (this->*step)();
    return true;
  }

  [[gnu::noinline]] void read_header() {
    jpeg_create_decompress(&state_);
    jpeg_mem_src(&state_, reinterpret_cast<const unsigned char*>(bytes_.data()), bytes_.size());
    jpeg_read_header(&state_, TRUE);
  }

  [[gnu::noinline]] void read_rows() {
    has_multiple_scans_ = jpeg_has_multiple_scans(&state_) != 0;
    jpeg_start_decompress(&state_);
    while (state_.output_scanline < state_.output_height) {
      JSAMPROW row = rows_ + state_.output_scanline * row_size_;
      jpeg_read_scanlines(&state_, &row, 1);
    }
    jpeg_finish_decompress(&state_);
  }

  [[noreturn]] void fail() const {
    throw InputError(location_,
                     std::string("is no JPEG picture or is damaged: ") + errors_.message.data());
  }

  std::span<const std::byte> bytes_;
  const std::string& location_;
  jpeg_decompress_struct state_{};
  JpegErrors errors_;
  bool has_multiple_scans_ = false;
  JSAMPROW rows_ = nullptr;
  std::size_t row_size_ = 0;
};

/// Of inks as Adobe's programs store them, inverted.
Rgb8 rgb_of(const Cmyk8& inks) {
  Rgb8 rgb;
  for (std::size_t k = 0; k < rgb.size(); ++k)
    rgb[k] = static_cast<std::uint8_t>(inks[3] - ((255 - inks[k]) * inks[3] >> 8));
  return rgb;
}

ImageRgb8 rgb_of(const Image<Cmyk8>& inks) {
  ImageRgb8 image(inks.width(), inks.height());
  for (std::size_t i = 0; i < inks.size(); ++i) image.data()[i] = rgb_of(inks.data()[i]);
  return image;
}

}  // namespace

bool is_jpeg(std::span<const std::byte> bytes) { return begins_with(bytes, "\xFF\xD8\xFF"); }

ImageU8 decode_jpeg_grey(std::span<const std::byte> bytes, const std::string& location) {
  JpegReader reader(bytes, location);
  reader.begin();
  if (reader.is_cmyk()) return grey_from(rgb_of(reader.pixels<Cmyk8>(JCS_CMYK)));
  return reader.pixels<std::uint8_t>(JCS_GRAYSCALE);
}

ImageRgb8 decode_jpeg_rgb(std::span<const std::byte> bytes, const std::string& location) {
  JpegReader reader(bytes, location);
  reader.begin();
  if (reader.is_cmyk()) return rgb_of(reader.pixels<Cmyk8>(JCS_CMYK));
  return reader.pixels<Rgb8>(JCS_RGB);
}

}  // namespace saccade
