#pragma once

#include <cstddef>
#include <vector>

#include "simulator/scene/light/light_options.h"

namespace saccade {

/// How many lights a light counts for: an area light for each of its emitters.
[[nodiscard]] std::size_t emitter_count(const LightOptions& light);

/// What stands for a light: an area light's emitters, else the light itself. Each emitter is a point
/// on the area with an equal part of its light, which it sends out as Lambert's law has it,
///   irradiance = intensity cos(a) cos(b) / distance^2
/// with the angles a at the lit surface and b at the emitter. A rectangle's n x n points are a square
/// grid turned by atan(1 / n),
///   ((i + (j + 1/2) / n) / n, (j + (n - i - 1/2) / n) / n)   with i, j = 0 .. n - 1
/// one in each of n x n cells, and one in each of n^2 columns and n^2 rows: the edge of a shadow that
/// is parallel to a side uncovers them one by one. They have the centre and the second moments of
/// the rectangle, but for n^-4 of these. Those of a disc are a sunflower's, n^2 of one area each.
[[nodiscard]] std::vector<LightOptions> emitters_of(const LightOptions& light);

}  // namespace saccade
