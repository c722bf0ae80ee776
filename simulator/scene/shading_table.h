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
  [[nodiscard]] float self_light(TriangleId triangle) const {
    return rows_[triangle].self_light;
  }

 private:
  struct Form {
    float x, y, z, offset;
  };
  struct alignas(64) Row {
    Form plane, column, row;
    float factor, self_light;
    std::uint32_t texture;  ///< index; kUntextured
    std::uint32_t object;
    std::array<Form, 3> normal;  ///< the shading normal at a point, not normalized
  };
  using Forms = std::array<FloatLanes, 4>;
  static constexpr std::uint32_t kUntextured = 0xffffffff;

  [[nodiscard]] static FloatLanes at(const Forms& form, const LaneVectors& point);
  template <class Select>
  [[nodiscard]] Forms gather(const std::array<TriangleId, kRayPacket>& triangles,
                             std::size_t count, const Select& select) const;

  std::vector<Row> rows_;
  std::vector<const Texture*> textures_;
  bool is_precise_ = true;
};

}  // namespace saccade
