#include "core/io/images/tiff_file.h"

#include <tiffio.h>

#include <algorithm>
#include <array>
#include <cstdarg>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <memory>
#include <vector>

#include "core/error.h"
#include "core/io/images/picture_bytes.h"

namespace saccade {
namespace {

struct TiffMemory {
  std::span<const std::byte> bytes;
  std::uint64_t position = 0;
  std::string error;
};

TiffMemory& tiff_memory(void* handle) { return *static_cast<TiffMemory*>(handle); }

tmsize_t tiff_read(thandle_t handle, void* out, tmsize_t size) {
  TiffMemory& memory = tiff_memory(handle);
  if (memory.position >= memory.bytes.size()) return 0;
  const std::size_t count =
      std::min<std::size_t>(static_cast<std::size_t>(size), memory.bytes.size() - memory.position);
  std::memcpy(out, memory.bytes.data() + memory.position, count);
  memory.position += count;
  return static_cast<tmsize_t>(count);
}

tmsize_t tiff_write(thandle_t /*handle*/, void* /*bytes*/, tmsize_t /*size*/) { return -1; }

toff_t tiff_seek(thandle_t handle, toff_t offset, int whence) {
  TiffMemory& memory = tiff_memory(handle);
  const std::uint64_t origin = whence == SEEK_CUR   ? memory.position
                               : whence == SEEK_END ? memory.bytes.size()
                                                    : 0;
  return memory.position = origin + offset;
}

int tiff_close(thandle_t /*handle*/) { return 0; }

toff_t tiff_size(thandle_t handle) { return tiff_memory(handle).bytes.size(); }

/// The first is the cause.
int on_tiff_error(TIFF* /*tiff*/, void* handle, const char* /*module*/, const char* format,
                  std::va_list arguments) {
  std::array<char, 200> text{};
  std::vsnprintf(text.data(), text.size(), format, arguments);
  if (tiff_memory(handle).error.empty()) tiff_memory(handle).error = text.data();
  return 1;
}

int on_tiff_warning(TIFF* /*tiff*/, void* /*handle*/, const char* /*module*/,
                    const char* /*format*/, std::va_list /*arguments*/) {
  return 1;
}

using TiffOptions = std::unique_ptr<TIFFOpenOptions, void (*)(TIFFOpenOptions*)>;
using TiffFile = std::unique_ptr<TIFF, void (*)(TIFF*)>;

TiffFile open_tiff(TiffMemory& memory) {
  const TiffOptions options(TIFFOpenOptionsAlloc(), TIFFOpenOptionsFree);
  TIFFOpenOptionsSetErrorHandlerExtR(options.get(), on_tiff_error, &memory);
  TIFFOpenOptionsSetWarningHandlerExtR(options.get(), on_tiff_warning, &memory);
  return {TIFFClientOpenExt("memory", "rm", &memory, tiff_read, tiff_write, tiff_seek, tiff_close,
                            tiff_size, nullptr, nullptr, options.get()),
          TIFFClose};
}

}  // namespace

bool is_tiff(std::span<const std::byte> bytes) {
  using namespace std::string_view_literals;
  constexpr std::array kBegins{"II*\0"sv, "MM\0*"sv, "II+\0"sv, "MM\0+"sv};
  return std::ranges::any_of(kBegins,
                             [&](std::string_view begin) { return begins_with(bytes, begin); });
}

ImageRgba8 decode_tiff(std::span<const std::byte> bytes, const std::string& location) {
  TiffMemory memory{bytes, 0, {}};
  const auto fail = [&](const std::string& otherwise) {
    throw InputError(location, "is no TIFF picture that can be decoded, or is damaged: " +
                                   (memory.error.empty() ? otherwise : memory.error));
  };
  const TiffFile file = open_tiff(memory);
  if (!file) fail("it has no header");
  std::uint32_t width = 0, height = 0;
  TIFFGetField(file.get(), TIFFTAG_IMAGEWIDTH, &width);
  TIFFGetField(file.get(), TIFFTAG_IMAGELENGTH, &height);
  check_picture_size(width, height, bytes.size(), location);
  std::array<char, 1024> reason{};
  if (TIFFRGBAImageOK(file.get(), reason.data()) == 0) fail(reason.data());
  std::vector<std::uint32_t> packed(std::size_t{width} * height);
  constexpr int kStopAtErrors = 1;
  if (TIFFReadRGBAImageOriented(file.get(), width, height, packed.data(), ORIENTATION_TOPLEFT,
                                kStopAtErrors) == 0)
    fail("it ends too early");
  ImageRgba8 image(static_cast<int>(width), static_cast<int>(height));
  std::ranges::transform(packed, image.data(), [](std::uint32_t pixel) {
    return Rgba8{
        static_cast<std::uint8_t>(TIFFGetR(pixel)), static_cast<std::uint8_t>(TIFFGetG(pixel)),
        static_cast<std::uint8_t>(TIFFGetB(pixel)), static_cast<std::uint8_t>(TIFFGetA(pixel))};
  });
  return image;
}

}  // namespace saccade
