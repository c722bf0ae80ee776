#include "core/io/images/picture_bytes.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/error.h"

namespace saccade {

bool begins_with(std::span<const std::byte> bytes, std::string_view begin) {
  return bytes.size() >= begin.size() &&
         std::ranges::equal(bytes.first(begin.size()), begin,
                            [](std::byte a, char b) { return a == static_cast<std::byte>(b); });
}

void check_picture_size(std::uint64_t width, std::uint64_t height, const std::string& location) {
  if (width == 0 || height == 0) throw InputError(location, "is a picture without pixels");
  if (width > kMostPictureSide || height > kMostPictureSide || width * height > kMostPixels)
    throw InputError(location,
                     fmt::format("is a picture of {} x {} pixels; at most {} in all and {} a side "
                                 "can be decoded",
                                 width, height, kMostPixels, kMostPictureSide));
}

void check_picture_size(std::uint64_t width, std::uint64_t height, std::size_t file_bytes,
                        const std::string& location) {
  check_picture_size(width, height, location);
  constexpr std::uint64_t kAlwaysAllowed = std::uint64_t{1} << 26U;
  constexpr std::uint64_t kMostPixelsOfAByte = 4096;
  if (width * height > kAlwaysAllowed + kMostPixelsOfAByte * file_bytes)
    throw InputError(location,
                     fmt::format("claims {} x {} pixels, which {} bytes hardly hold: it is "
                                 "damaged, or made to take all memory",
                                 width, height, file_bytes));
}

void PictureBytes::fail(const std::string& problem) const {
  throw InputError(location_,
                   fmt::format("is no {} picture that can be decoded: it {}", kind_, problem));
}

}  // namespace saccade
