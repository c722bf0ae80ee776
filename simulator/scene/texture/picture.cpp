#include "simulator/scene/texture/picture.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <filesystem>

#include "core/error.h"
#include "core/io/images/exr_file.h"
#include "core/io/images/hdr_file.h"
#include "core/io/images/image_file.h"
#include "core/srgb.h"

namespace saccade {
namespace {

std::span<const std::byte> as_bytes(const Bytes& bytes) { return std::as_bytes(std::span(bytes)); }

std::string lower_extension(const std::string& source_name) {
  std::string extension = std::filesystem::path(source_name).extension().string();
  for (char& c : extension) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return extension;
}

template <class Pixel, class Convert>
ImageF converted(const Image<Pixel>& image, const Convert& convert) {
  ImageF result(image.width(), image.height());
  std::ranges::transform(image.pixels(), result.data(), convert);
  return result;
}

ImageF grey_of(const ImageRgbF& image, const RgbF& factors, ColourChannel channel) {
  return converted(image, [&](const RgbF& p) {
    return in_channel(channel, factors[0] * p[0], factors[1] * p[1], factors[2] * p[2]);
  });
}

ImageF grey_of(const ImageRgba8& image, const RgbF& factors, ColourChannel channel) {
  std::array<float, 256> linear;
  for (int code = 0; code < 256; ++code)
    linear[static_cast<std::size_t>(code)] = linear_from_srgb8(static_cast<std::uint8_t>(code));
  return converted(image, [&](const Rgba8& p) {
    return in_channel(channel, factors[0] * linear[p[0]], factors[1] * linear[p[1]],
                      factors[2] * linear[p[2]]);
  });
}

ImageF alpha_of(const ImageRgba8& image) {
  return converted(image, [](const Rgba8& p) { return static_cast<float>(p[3]) / 255; });
}

/// Light this fraction of the brightest below 0 is what filters leave.
constexpr float kDarkest = -1e-2F;

void check_light(ImageF& image, const std::string& source_name, SceneRemarks& remarks) {
  float brightest = 0;
  for (const float value : image.pixels())
    if (std::isfinite(value)) brightest = std::max(brightest, value);
  std::size_t below = 0;
  float lowest = 0;
  for (int y = 0; y < image.height(); ++y)
    for (int x = 0; x < image.width(); ++x) {
      float& value = image(x, y);
      if (value >= 0 && std::isfinite(value)) continue;
      if (!std::isfinite(value) || value < kDarkest * brightest)
        throw InputError(
            source_name,
            fmt::format("texel ({}, {}) is {}, but light is finite and not negative", x, y, value));
      ++below;
      lowest = std::min(lowest, value);
      value = 0;
    }
  if (below > 0)
    remarks.say(
        fmt::format("{}: {} texels below 0, down to {}, count as 0", source_name, below, lowest));
}

}  // namespace

Picture decode_picture(const Bytes& bytes, const std::string& source_name, SceneRemarks& remarks,
                       const RgbF& factors, ColourChannel channel) {
  const std::string extension = lower_extension(source_name);
  Picture picture;
  if (extension == ".exr") {
    picture.grey = grey_of(decode_exr_rgb(as_bytes(bytes), source_name), factors, channel);
  } else if (extension == ".hdr") {
    picture.grey = grey_of(decode_hdr(as_bytes(bytes), source_name), factors, channel);
  } else {
    const ImageRgba8 image = decode_image_rgba(as_bytes(bytes), source_name);
    picture.grey = grey_of(image, factors, channel);
    if (std::ranges::any_of(image.pixels(), [](const Rgba8& p) { return p[3] != 255; }))
      picture.opacity = alpha_of(image);
  }
  check_light(picture.grey, source_name, remarks);
  return picture;
}

ImageF decode_opacity(const Bytes& bytes, const std::string& source_name, SceneRemarks& remarks) {
  const std::string extension = lower_extension(source_name);
  if (extension == ".exr" || extension == ".hdr")
    return decode_picture(bytes, source_name, remarks).grey;
  const ImageRgba8 image = decode_image_rgba(as_bytes(bytes), source_name);
  if (std::ranges::any_of(image.pixels(), [](const Rgba8& p) { return p[3] != 255; }))
    return alpha_of(image);
  return converted(image, [](const Rgba8& p) { return luminance(p[0], p[1], p[2]) / 255.0F; });
}

}  // namespace saccade
