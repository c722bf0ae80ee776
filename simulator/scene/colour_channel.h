#pragma once

#include "core/srgb.h"

namespace saccade {

/// What of the colours of a scene becomes its light: the luminance, as a grey sensor sees it, or
/// one of the linear primaries of sRGB, as a pixel behind a colour filter does.
enum class ColourChannel { kLuminance, kRed, kGreen, kBlue };

/// Of linear light.
[[nodiscard]] constexpr float in_channel(ColourChannel channel, float r, float g, float b) {
  switch (channel) {
    case ColourChannel::kRed:
      return r;
    case ColourChannel::kGreen:
      return g;
    case ColourChannel::kBlue:
      return b;
    default:
      return luminance(r, g, b);
  }
}

}  // namespace saccade
