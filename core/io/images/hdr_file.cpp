#include "core/io/images/hdr_file.h"

#include <fmt/format.h>

#include <array>
#include <charconv>
#include <cmath>
#include <string_view>
#include <vector>

#include "core/io/images/picture_bytes.h"

namespace saccade {
namespace {

using Rgbe = std::array<std::uint8_t, 4>;

/// Rows of other lengths are never run-length encoded.
constexpr int kHdrShortest = 8, kHdrLongest = 0x7FFF;

/// Takes the line that begins at `at`, without its end.
std::string take_hdr_line(const PictureBytes& bytes, std::size_t& at) {
  constexpr std::size_t kLongestLine = 4096;
  std::string line;
  while (true) {
    const unsigned c = bytes.u8(at++);
    if (c == '\n') return line;
    line += static_cast<char>(c);
    if (line.size() > kLongestLine) bytes.fail("has an endless line in its header");
  }
}

/// `at` is then where the pixels begin.
std::array<int, 2> read_hdr_size(const PictureBytes& bytes, std::size_t& at) {
  std::string line = take_hdr_line(bytes, at);
  if (!line.starts_with("#?")) bytes.fail("does not begin with '#?'");
  while (!line.empty()) {
    if (line.starts_with("FORMAT=") && !line.starts_with("FORMAT=32-bit_rle_rgbe"))
      bytes.fail("is of the format " + line.substr(7) + "; 32-bit_rle_rgbe can be read");
    line = take_hdr_line(bytes, at);
  }
  const std::string size = take_hdr_line(bytes, at);
  std::array<int, 2> height_width{};
  std::string_view rest = size;
  for (std::size_t k = 0; k < 2; ++k) {
    const std::string_view axis = k == 0 ? "-Y " : " +X ";
    if (!rest.starts_with(axis))
      bytes.fail(fmt::format("has the size '{}', not '-Y H +X W'", size));
    rest.remove_prefix(axis.size());
    const auto [end, error] =
        std::from_chars(rest.data(), rest.data() + rest.size(), height_width[k]);
    if (error != std::errc() || height_width[k] <= 0)
      bytes.fail(fmt::format("has the size '{}', not '-Y H +X W'", size));
    rest.remove_prefix(static_cast<std::size_t>(end - rest.data()));
  }
  return {height_width[1], height_width[0]};
}

Rgbe hdr_pixel(const PictureBytes& bytes, std::size_t at) {
  Rgbe pixel;
  for (std::size_t k = 0; k < 4; ++k) pixel[k] = static_cast<std::uint8_t>(bytes.u8(at + k));
  return pixel;
}

/// One component of a row after the other: a byte above 128 repeats the next 128 times less, one
/// below states how many follow.
void read_hdr_runs(const PictureBytes& bytes, std::size_t& at, std::vector<Rgbe>& row) {
  for (std::size_t k = 0; k < 4; ++k)
    for (std::size_t x = 0; x < row.size();) {
      const unsigned code = bytes.u8(at++);
      const std::size_t count = code > 128 ? code - 128 : code;
      if (count == 0 || count > row.size() - x) bytes.fail("has a run beyond its border");
      for (std::size_t i = 0; i < count; ++i)
        row[x++][k] = static_cast<std::uint8_t>(bytes.u8(code > 128 ? at : at + i));
      at += code > 128 ? 1 : count;
    }
}

void read_hdr_row(const PictureBytes& bytes, std::size_t& at, std::vector<Rgbe>& row) {
  const auto width = static_cast<int>(row.size());
  const Rgbe first = hdr_pixel(bytes, at);
  const bool is_encoded = width >= kHdrShortest && width <= kHdrLongest && first[0] == 2 &&
                          first[1] == 2 && first[2] * 256 + first[3] == width;
  if (is_encoded) {
    at += 4;
    read_hdr_runs(bytes, at, row);
    return;
  }
  for (Rgbe& pixel : row) {
    pixel = hdr_pixel(bytes, at);
    at += 4;
  }
}

/// Mantissas with a common exponent, 128 + 8 above that of their unit.
RgbF hdr_light(const Rgbe& pixel) {
  if (pixel[3] == 0) return {0, 0, 0};
  const auto unit = static_cast<float>(std::ldexp(1.0, pixel[3] - 136));
  return {static_cast<float>(pixel[0]) * unit, static_cast<float>(pixel[1]) * unit,
          static_cast<float>(pixel[2]) * unit};
}

}  // namespace

ImageRgbF decode_hdr(std::span<const std::byte> bytes, const std::string& location) {
  const PictureBytes source(bytes, location, "Radiance");
  std::size_t at = 0;
  const auto [width, height] = read_hdr_size(source, at);
  check_picture_size(static_cast<std::uint64_t>(width), static_cast<std::uint64_t>(height),
                     location);
  // A run of 127 of each component takes eight bytes.
  constexpr std::uint64_t kMostOfAByte = 16;
  if (static_cast<std::uint64_t>(width) * static_cast<std::uint64_t>(height) >
      kMostOfAByte * source.size())
    source.fail("ends too early");
  ImageRgbF image(width, height);
  std::vector<Rgbe> row(static_cast<std::size_t>(width));
  for (int y = 0; y < height; ++y) {
    read_hdr_row(source, at, row);
    for (int x = 0; x < width; ++x) image(x, y) = hdr_light(row[static_cast<std::size_t>(x)]);
  }
  return image;
}

}  // namespace saccade
