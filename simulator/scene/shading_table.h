#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "simulator/scene/ray_lanes.h"
#include "simulator/scene/texture/texture.h"

namespace saccade {

struct LitLanes;
struct TriangleSurface;
struct TriangleInterior;

/// All that shading a static triangle reads, in single precision and within two cache lines: what a
/// packet of rays sees is computed from it in all lanes at once.
class ShadingTable {
 public:
  /// `normals`: empty without lights.
  ShadingTable(const std::vector<TriangleSurface>& surfaces,
               const std::vector<TriangleInterior>& interiors,
               const std::vector<std::array<Eigen::Vector3f, 3>>& normals);

  /// Whether all coordinates are small enough for single precision: a texel is resolved to a
  /// hundredth, and a position to a ten-thousandth of a metre.
  [[nodiscard]] bool is_precise() const { return is_precise_; }

  /// Starts to load what shade() will read.
  void prefetch(const std::array<TriangleId, kRayPacket>& triangles, std::size_t count) const;

  /// Albedo (as `radiance`), distance, texel coordinates and objects in the first `count` lanes of
  /// `view`, of its triangles; distance 0 where a ray misses the plane. `filtered`: over the rays'
  /// footprints.
  void sample(const RayLanes& rays, std::size_t count, bool filtered, ViewLanes& view) const;
  /// Where lights reach these points, after sample().
  void find_points(const RayLanes& rays, std::size_t count, const ViewLanes& view,
                   LitLanes& points) const;

  /// As of the triangle's surface.
  [[nodiscard]] float self_light(TriangleId triangle) const { return rows_[triangle].self_light; }

 private:
  struct Gradient {
    float x, y, z;
  };
  /// Everything is affine in the point's distance from the first corner, which keeps the numbers
  /// small.
  struct alignas(64) Row {
    Gradient corner;
    Gradient plane;  ///< the unit normal
    Gradient column, row;
    float column_at_corner, row_at_corner;
    std::uint32_t texture;  ///< index; kUntextured
    std::uint32_t object;
    std::array<Gradient, 3> normal;  ///< components of the shading normal, not normalized,
    Gradient normal_at_corner;
    float factor, self_light;
  };
  static constexpr std::uint32_t kUntextured = 0xffffffff;

  template <class Select>
  [[nodiscard]] LaneVectors gather(const std::array<TriangleId, kRayPacket>& triangles,
                                   std::size_t count, const Select& select) const;

  std::vector<Row> rows_;
  std::vector<const Texture*> textures_;
  bool is_precise_ = true;
};

}  // namespace saccade
