#include "core/io/images/image_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <string_view>
#include <vector>

#include "core/error.h"
#include "core/io/files/atomic_file.h"
#include "core/io/files/file_bytes.h"
#include "core/io/images/bmp_file.h"
#include "core/io/images/dds_file.h"
#include "core/io/images/jpeg_file.h"
#include "core/io/images/png_file.h"
#include "core/io/images/rgb_grey.h"
#include "core/io/images/tga_file.h"
#include "core/io/images/tiff_file.h"
#include "core/io/images/webp_file.h"

namespace saccade {
namespace {

constexpr std::string_view kKnownPictures = "PNG, JPEG, BMP, TIFF and WebP";

bool is_named_tga(const std::string& location) {
  std::string ending = std::filesystem::path(location).extension().string();
  for (char& c : ending) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return ending == ".tga";
}

/// KTX and KTX 2 begin alike.
bool is_ktx(std::span<const std::byte> bytes) {
  constexpr std::array<unsigned char, 5> kBegin{0xAB, 'K', 'T', 'X', ' '};
  return bytes.size() >= kBegin.size() &&
         std::ranges::equal(bytes.first(kBegin.size()), kBegin, [](std::byte a, unsigned char b) {
           return std::to_integer<unsigned char>(a) == b;
         });
}

/// Kinds whose codes are brought to RGBA first.
ImageRgba8 decode_other(std::span<const std::byte> bytes, const std::string& location) {
  if (bytes.empty()) throw InputError(location, "is empty, not a picture");
  if (is_webp(bytes)) return decode_webp(bytes, location);
  if (is_bmp(bytes)) return decode_bmp(bytes, location);
  if (is_tiff(bytes)) return decode_tiff(bytes, location);
  throw InputError(location,
                   fmt::format("is no picture that can be decoded: {} can", kKnownPictures));
}

ImageRgb8 without_alpha(const ImageRgba8& picture) {
  ImageRgb8 rgb(picture.width(), picture.height());
  std::ranges::transform(picture.pixels(), rgb.data(), [](const Rgba8& p) {
    return Rgb8{p[0], p[1], p[2]};
  });
  return rgb;
}

ImageRgba8 with_alpha(const ImageRgb8& picture) {
  ImageRgba8 rgba(picture.width(), picture.height());
  std::ranges::transform(picture.pixels(), rgba.data(), [](const Rgb8& p) {
    return Rgba8{p[0], p[1], p[2], 255};
  });
  return rgba;
}

std::vector<std::byte> read_png_bytes(const std::filesystem::path& file) {
  std::vector<std::byte> bytes = read_file_bytes(file);
  if (!is_png(bytes)) throw InputError(file.string(), "is no PNG picture");
  return bytes;
}

}  // namespace

ImageU8 read_image_grey(const std::filesystem::path& file) {
  const std::vector<std::byte> bytes = read_file_bytes(file);
  if (is_png(bytes)) return decode_png_grey(bytes, file.string());
  if (is_jpeg(bytes)) return decode_jpeg_grey(bytes, file.string());
  return grey_from(decode_other(bytes, file.string()));
}

ImageRgb8 read_image_rgb(const std::filesystem::path& file) {
  const std::vector<std::byte> bytes = read_file_bytes(file);
  if (is_png(bytes)) return decode_png_rgb(bytes, file.string());
  if (is_jpeg(bytes)) return decode_jpeg_rgb(bytes, file.string());
  return without_alpha(decode_other(bytes, file.string()));
}

ImageU16 read_image_u16(const std::filesystem::path& file) {
  return decode_png_u16(read_png_bytes(file), file.string());
}

ImageRgb16 read_image_rgb16(const std::filesystem::path& file) {
  return decode_png_rgb16(read_png_bytes(file), file.string());
}

ImageRgba8 read_image_rgba(const std::filesystem::path& file) {
  return decode_image_rgba(read_file_bytes(file), file.string());
}

ImageRgba8 decode_image_rgba(std::span<const std::byte> bytes, const std::string& location) {
  if (is_dds(bytes)) return decode_dds(bytes, location);
  if (is_ktx(bytes))
    throw InputError(location, "is a KTX picture, which cannot be decoded: convert it to PNG");
  if (is_named_tga(location)) return decode_tga(bytes, location);
  if (is_png(bytes)) return decode_png_rgba(bytes, location);
  if (is_jpeg(bytes)) return with_alpha(decode_jpeg_rgb(bytes, location));
  return decode_other(bytes, location);
}

void write_png(const std::filesystem::path& file, const ImageU16& image) {
  write_atomically(file, encode_png(image));
}

void write_png(const std::filesystem::path& file, const ImageRgb16& image) {
  write_atomically(file, encode_png(image));
}

void write_png(const std::filesystem::path& file, const ImageU8& image) {
  write_atomically(file, encode_png(image));
}

void write_png(const std::filesystem::path& file, const ImageRgb8& image) {
  write_atomically(file, encode_png(image));
}

}  // namespace saccade
