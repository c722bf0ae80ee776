#include "core/io/images/webp_file.h"

#include <webp/decode.h>
#include <webp/encode.h>

#include <algorithm>
#include <memory>

#include "core/check.h"
#include "core/error.h"
#include "core/io/images/picture_bytes.h"

namespace saccade {

std::string encode_webp(const ImageRgb8& image) {
  SACCADE_CHECK(!image.empty() && std::max(image.width(), image.height()) <= kMostWebpSide);
  std::uint8_t* bytes = nullptr;
  const std::size_t size =
      WebPEncodeLosslessRGB(image.data()->data(), image.width(), image.height(),
                            static_cast<int>(sizeof(Rgb8)) * image.width(), &bytes);
  const std::unique_ptr<std::uint8_t, void (*)(void*)> owner(bytes, WebPFree);
  SACCADE_CHECK(size > 0);
  return {reinterpret_cast<const char*>(bytes), size};
}

bool is_webp(std::span<const std::byte> bytes) {
  constexpr std::size_t kKind = 8;
  return begins_with(bytes, "RIFF") &&
         begins_with(bytes.subspan(std::min(kKind, bytes.size())), "WEBP");
}

ImageRgba8 decode_webp(std::span<const std::byte> bytes, const std::string& location) {
  const auto* begin = reinterpret_cast<const std::uint8_t*>(bytes.data());
  WebPBitstreamFeatures features;
  if (WebPGetFeatures(begin, bytes.size(), &features) != VP8_STATUS_OK)
    throw InputError(location, "is no WebP picture or is damaged");
  if (features.has_animation != 0)
    throw InputError(location, "is a WebP film; a still picture can be decoded");
  const auto width = static_cast<std::size_t>(features.width);
  check_picture_size(width, static_cast<std::size_t>(features.height), bytes.size(), location);
  ImageRgba8 image(features.width, features.height);
  if (WebPDecodeRGBAInto(begin, bytes.size(), image.data()->data(), image.size() * sizeof(Rgba8),
                         static_cast<int>(width * sizeof(Rgba8))) == nullptr)
    throw InputError(location, "is a WebP picture that is damaged or ends too early");
  return image;
}

}  // namespace saccade
