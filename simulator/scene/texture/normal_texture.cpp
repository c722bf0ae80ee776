#include "simulator/scene/texture/normal_texture.h"

#include <fmt/format.h>

#include <cctype>
#include <cmath>
#include <filesystem>
#include <span>
#include <utility>

#include "core/check.h"
#include "core/error.h"
#include "core/io/images/exr_file.h"
#include "core/io/images/hdr_file.h"
#include "core/io/images/image_file.h"

namespace saccade {
namespace {

/// The three planes of a picture whose codes are codes(pixel)[k] within 0 .. 1.
template <class Pixel, class Codes>
std::array<ImageF, 3> parts_of(const Image<Pixel>& image, float scale, const Codes& codes) {
  std::array<ImageF, 3> parts;
  for (std::size_t axis = 0; axis < parts.size(); ++axis) {
    parts[axis] = ImageF(image.width(), image.height());
    const float factor = axis < 2 ? scale : 1;
    for (int y = 0; y < image.height(); ++y)
      for (int x = 0; x < image.width(); ++x)
        parts[axis](x, y) = factor * (2 * codes(image(x, y), axis) - 1);
  }
  return parts;
}

std::string ending_of(const std::string& source_name) {
  std::string ending = std::filesystem::path(source_name).extension().string();
  for (char& c : ending) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return ending;
}

}  // namespace

NormalTexture::NormalTexture(std::array<ImageF, 3> parts, const WrapModes& wrap)
    : parts_{Texture(std::move(parts[0]), wrap.u, wrap.v),
             Texture(std::move(parts[1]), wrap.u, wrap.v),
             Texture(std::move(parts[2]), wrap.u, wrap.v)} {
  for (const Texture& part : parts_)
    SACCADE_CHECK(part.width() == width() && part.height() == height());
}

NormalTexture decode_normal_map(const Bytes& bytes, const std::string& source_name,
                                const WrapModes& wrap, float scale) {
  const std::span<const std::byte> data = std::as_bytes(std::span(bytes));
  const std::string ending = ending_of(source_name);
  const auto of_floats = [&](const ImageRgbF& image) {
    return parts_of(image, scale, [](const RgbF& p, std::size_t axis) { return p[axis]; });
  };
  std::array<ImageF, 3> parts = ending == ".exr" ? of_floats(decode_exr_rgb(data, source_name))
                                : ending == ".hdr"
                                    ? of_floats(decode_hdr(data, source_name))
                                    : parts_of(decode_image_rgba(data, source_name), scale,
                                               [](const Rgba8& p, std::size_t axis) {
                                                 return static_cast<float>(p[axis]) / 255;
                                               });
  for (const ImageF& part : parts)
    for (const float value : part.pixels())
      if (!std::isfinite(value))
        throw InputError(source_name, "a texel of this normal map is not finite");
  return {std::move(parts), wrap};
}

}  // namespace saccade
