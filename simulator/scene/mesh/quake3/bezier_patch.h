#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace saccade {

/// A vertex of a Quake III map.
struct Quake3Vertex {
  std::array<float, 3> position;
  std::array<float, 2> uv;  ///< v downwards, as the game has it
  std::array<float, 3> normal;
};

/// A grid of vertices, row by row.
struct Quake3Grid {
  std::size_t width = 0, height = 0;
  std::vector<Quake3Vertex> vertices;
};

/// Into how many parts each curve of a patch is divided. It is the same for all, so that patches
/// that share a border share its vertices, and no gap opens between them. The
/// chords of a quarter of a cylinder are off its curve by at most 0.6 % of the radius.
constexpr std::size_t kPatchParts = 8;

/// Vertices of the grid of a surface of `width` x `height` control points.
[[nodiscard]] std::size_t divided_count(std::size_t width, std::size_t height);

/// A surface of biquadratic Bezier patches, which share their borders, as a grid. `control`: their
/// control points, row by row, `width` of them in a row; width and height are odd and at least 3.
[[nodiscard]] Quake3Grid divide_patch(std::span<const Quake3Vertex> control, std::size_t width);

}  // namespace saccade
