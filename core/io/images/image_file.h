#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>

#include "core/image.h"

namespace saccade {

using Rgba8 = std::array<std::uint8_t, 4>;
using ImageRgba8 = Image<Rgba8>;
using ImageU16 = Image<std::uint16_t>;
using Rgb16 = std::array<std::uint16_t, 3>;
using ImageRgb16 = Image<Rgb16>;

/// 8-bit pictures (PNG, JPEG, BMP, TIFF, WebP; told by how they begin) as their stored codes;
/// colour is turned to grey and grey to colour where the file has the other. 16-bit files lose
/// their low byte. InputError with the path when a file is missing, no picture, damaged, or larger
/// than 2^29 pixels.
[[nodiscard]] ImageU8 read_image_grey(const std::filesystem::path& file);
[[nodiscard]] ImageRgb8 read_image_rgb(const std::filesystem::path& file);
/// With the alpha channel; 255 where the file has none. Takes TGA, by the file's name, and DDS as
/// well.
[[nodiscard]] ImageRgba8 read_image_rgba(const std::filesystem::path& file);
/// The same from memory; `location` is what errors name.
[[nodiscard]] ImageRgba8 decode_image_rgba(std::span<const std::byte> bytes,
                                           const std::string& location);
/// 16-bit PNG files of one or of three channels, whose codes are labels or numbers: all bits as they
/// are stored. InputError with the path for files of any other kind.
[[nodiscard]] ImageU16 read_image_u16(const std::filesystem::path& file);
[[nodiscard]] ImageRgb16 read_image_rgb16(const std::filesystem::path& file);

void write_png(const std::filesystem::path& file, const ImageU16& image);
void write_png(const std::filesystem::path& file, const ImageRgb16& image);
void write_png(const std::filesystem::path& file, const ImageU8& image);
void write_png(const std::filesystem::path& file, const ImageRgb8& image);
/// Not empty (contract).
[[nodiscard]] std::string encode_png(const ImageU8& image);
[[nodiscard]] std::string encode_png(const ImageU16& image);
[[nodiscard]] std::string encode_png(const ImageRgb8& image);
[[nodiscard]] std::string encode_png(const ImageRgb16& image);
[[nodiscard]] std::string encode_png(const ImageRgba8& image);

}  // namespace saccade
