#pragma once

#include "simulator/sensor/signal/cell_bounds.h"

namespace saccade {

/// Bounds of a texture along a path: of its value and of the value's rate [1/s], which is unknown
/// (infinite) where the path leaves a cell.
struct TextureRange {
  Interval values;
  Interval rates{-RadianceRange::kUnknown, RadianceRange::kUnknown};
};

/// Of one picture. A box within one cell is bounded by the bilinear function there; a larger one by
/// its texels.
[[nodiscard]] TextureRange texture_range(const RaySample& from, const RaySample& to,
                                         double length_s);

/// Whether any of the path is seen through a coarser level of the texture's pyramid.
[[nodiscard]] inline bool is_filtered(const RaySample& from, const RaySample& to) {
  return from.surface.level > 0 || to.surface.level > 0;
}

/// Of a pyramid of pictures. Between two levels k and k + 1 the value is A + f (B - A) with the
/// path's values A and B in both and f = level - k, hence its rate
///   (1 - f) A' + f B' + f' (B - A);
/// a path that crosses levels or cells is bounded by the texels of all levels that it crosses.
[[nodiscard]] TextureRange mipmap_range(const RaySample& from, const RaySample& to,
                                        double length_s);

/// split_fraction() of a filtered path: at the borders of levels and of both levels' cells, else
/// at the extremum.
[[nodiscard]] double mipmap_split_fraction(const RaySample& from, const RaySample& to,
                                           double length_s);

}  // namespace saccade
