#include "simulator/scene/mesh/quake3/bezier_patch.h"

#include <algorithm>

#include "core/check.h"

namespace saccade {
namespace {

/// Of three control points at t in [0, 1].
std::array<float, 3> bernstein(float t) { return {(1 - t) * (1 - t), 2 * t * (1 - t), t * t}; }

/// Where along a row of controls a vertex of the grid lies: its first control and how the three
/// from there on count.
struct CurvePlace {
  std::size_t control;
  std::array<float, 3> weights;
};

CurvePlace place_of(std::size_t index, std::size_t controls) {
  const std::size_t curve = std::min(index / kPatchParts, (controls - 3) / 2);
  const auto step = static_cast<float>(index - curve * kPatchParts);
  return {2 * curve, bernstein(step / static_cast<float>(kPatchParts))};
}

template <std::size_t N>
void add_weighted(float weight, const std::array<float, N>& part, std::array<float, N>& sum) {
  for (std::size_t i = 0; i < N; ++i) sum[i] += weight * part[i];
}

std::size_t divided(std::size_t controls) { return (controls - 1) / 2 * kPatchParts + 1; }

}  // namespace

std::size_t divided_count(std::size_t width, std::size_t height) {
  return divided(width) * divided(height);
}

Quake3Grid divide_patch(std::span<const Quake3Vertex> control, std::size_t width) {
  SACCADE_CHECK(width >= 3 && width % 2 == 1 && control.size() % width == 0);
  const std::size_t height = control.size() / width;
  SACCADE_CHECK(height >= 3 && height % 2 == 1);
  Quake3Grid grid{divided(width), divided(height), {}};
  grid.vertices.reserve(grid.width * grid.height);
  for (std::size_t y = 0; y < grid.height; ++y) {
    const CurvePlace row = place_of(y, height);
    for (std::size_t x = 0; x < grid.width; ++x) {
      const CurvePlace column = place_of(x, width);
      Quake3Vertex& vertex = grid.vertices.emplace_back();
      for (std::size_t j = 0; j < 3; ++j)
        for (std::size_t i = 0; i < 3; ++i) {
          const Quake3Vertex& c = control[(row.control + j) * width + column.control + i];
          const float weight = row.weights[j] * column.weights[i];
          add_weighted(weight, c.position, vertex.position);
          add_weighted(weight, c.uv, vertex.uv);
          add_weighted(weight, c.normal, vertex.normal);
        }
    }
  }
  return grid;
}

}  // namespace saccade
