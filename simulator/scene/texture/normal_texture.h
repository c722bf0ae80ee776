#pragma once

#include <array>
#include <cstddef>
#include <string>

#include <Eigen/Core>

#include "simulator/scene/mesh/file_source.h"
#include "simulator/scene/texture/texture.h"
#include "simulator/scene/texture/texture_library.h"

namespace saccade {

/// A tangent-space normal map (Khronos, glTF 2.0, 3.9.3): a texel's codes c of 0 .. 1 are the vector
///   ((2 r - 1) scale, (2 g - 1) scale, 2 b - 1)
/// along the tangent, the bitangent (upwards in the picture) and the normal. Between texels its parts
/// are bilinear; their direction counts, not their length. Immutable and thread-safe.
class NormalTexture {
 public:
  /// Parts in the order of the axes, all of one size.
  NormalTexture(std::array<ImageF, 3> parts, const WrapModes& wrap);

  [[nodiscard]] int width() const { return parts_[0].width(); }
  [[nodiscard]] int height() const { return parts_[0].height(); }
  /// One part as a texture.
  [[nodiscard]] const Texture& part(std::size_t axis) const { return parts_[axis]; }

  /// At texel coordinates, through a square of 2^level texels as Texture::at_texel() has it.
  [[nodiscard]] Eigen::Vector3d at_texel(double x, double y, double level) const {
    const auto value = [&](const Texture& part) {
      return level > 0 ? part.at_texel(x, y, level) : part.at_texel(x, y);
    };
    return {value(parts_[0]), value(parts_[1]), value(parts_[2])};
  }

 private:
  std::array<Texture, 3> parts_;
};

/// Decodes a picture by the ending of its name. InputError naming `source_name` when the bytes are no
/// such picture, or hold numbers that are not finite.
[[nodiscard]] NormalTexture decode_normal_map(const Bytes& bytes, const std::string& source_name,
                                              const WrapModes& wrap, float scale = 1);

}  // namespace saccade
