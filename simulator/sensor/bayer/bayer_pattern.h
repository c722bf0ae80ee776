#pragma once

#include <array>
#include <cstddef>

#include "core/camera.h"
#include "simulator/scene/colour_channel.h"
#include "simulator/scene/scene.h"

namespace saccade {

/// A scene in the light of each of three colours; its geometry is the same in all.
struct ColourScenes {
  Scene red, green, blue;

  [[nodiscard]] const Scene& of(ColourChannel channel) const {
    return channel == ColourChannel::kRed ? red : channel == ColourChannel::kGreen ? green : blue;
  }
};

/// Every second pixel in both directions of a sensor behind Bayer's filter RGGB: those of one
/// colour, of green one half.
struct BayerPart {
  int x0, y0;  ///< of its first pixel
  ColourChannel channel;

  /// The lens with these pixels alone: pixel (i, j) of it is pixel (x0 + 2 i, y0 + 2 j).
  [[nodiscard]] PinholeCamera of(const PinholeCamera& camera) const {
    PinholeCamera part = camera;
    part.width = (camera.width - x0 + 1) / 2;
    part.height = (camera.height - y0 + 1) / 2;
    part.fx = camera.fx / 2;
    part.fy = camera.fy / 2;
    part.cx = (camera.cx - x0) / 2;
    part.cy = (camera.cy - y0) / 2;
    return part;
  }
};

/// In units of the distance between the pixels of a part.
constexpr double kBayerPixelSide = 0.5;

constexpr std::array<BayerPart, 4> kBayerParts = {{{0, 0, ColourChannel::kRed},
                                                   {1, 0, ColourChannel::kGreen},
                                                   {0, 1, ColourChannel::kGreen},
                                                   {1, 1, ColourChannel::kBlue}}};

}  // namespace saccade
