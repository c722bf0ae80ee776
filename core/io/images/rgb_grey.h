#pragma once

#include <cstddef>
#include <cstdint>

#include "core/image.h"

namespace saccade {

/// 0.299 R + 0.587 G + 0.114 B (ITU-R BT.601) of the codes, in fixed point of 15 bits.
template <class Pixel>
[[nodiscard]] ImageU8 grey_from(const Image<Pixel>& picture) {
  ImageU8 grey(picture.width(), picture.height());
  for (std::size_t i = 0; i < picture.size(); ++i) {
    const auto& p = picture.data()[i];
    grey.data()[i] =
        static_cast<std::uint8_t>((9798 * p[0] + 19235 * p[1] + 3735 * p[2] + (1 << 14)) >> 15);
  }
  return grey;
}

}  // namespace saccade
