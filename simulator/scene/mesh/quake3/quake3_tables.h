#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "simulator/scene/mesh/file_source.h"

namespace saccade {

// Rows of the tables of a Quake III map, as they lie in the file.
struct Quake3ShaderRow {
  std::array<char, 64> name;
  std::uint32_t surface_flags;
  std::uint32_t content_flags;
};
struct Quake3ModelRow {
  std::array<float, 6> box;
  std::int32_t first_face, face_count;
  std::int32_t first_brush, brush_count;
};
struct Quake3VertexRow {
  std::array<float, 3> position;  ///< [units]
  std::array<float, 2> uv;        ///< v downwards
  std::array<float, 2> light_uv;
  std::array<float, 3> normal;
  std::array<std::uint8_t, 4> colour;
};
struct Quake3FaceRow {
  std::int32_t shader, fog, kind;
  std::int32_t first_vertex, vertex_count;
  std::int32_t first_corner, corner_count;  ///< counted from the face's first vertex
  std::array<std::int32_t, 5> light_map;
  std::array<float, 9> light_axes;
  std::array<float, 3> normal;
  std::array<std::int32_t, 2> patch_size;  ///< control points across and down
};

/// What a map states of its surfaces and things. No index has been checked.
struct Quake3Tables {
  std::string entities;
  std::vector<Quake3ShaderRow> shaders;
  std::vector<Quake3ModelRow> models;
  std::vector<Quake3VertexRow> vertices;
  std::vector<std::int32_t> corners;
  std::vector<Quake3FaceRow> faces;
};

/// Throws std::runtime_error where the bytes are no IBSP of version 46 or 47, or a table ends behind
/// them.
[[nodiscard]] Quake3Tables read_quake3_tables(const Bytes& bytes);

/// Throws std::runtime_error that names what is wrong.
[[noreturn]] void fail_as_damaged_map(const std::string& what);

/// `count` rows from `first` on; fails where there are fewer. `what` they are, for the error.
template <class Row>
[[nodiscard]] std::span<const Row> rows_of(const std::vector<Row>& all, std::int32_t first,
                                           std::int32_t count, const char* what) {
  if (first < 0 || count < 0 ||
      static_cast<std::size_t>(first) + static_cast<std::size_t>(count) > all.size())
    fail_as_damaged_map(
        fmt::format("it has no {} {} to {}", what, first, std::int64_t{first} + count - 1));
  return std::span(all).subspan(static_cast<std::size_t>(first), static_cast<std::size_t>(count));
}

}  // namespace saccade
