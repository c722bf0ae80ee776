#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include "simulator/scene/mesh/mesh.h"

namespace saccade {

/// The triangles of a mesh, each place but once. A table of numbers with open addressing: a node for
/// each of a million triangles takes as long as all else that is done with them.
class DistinctTriangles {
 public:
  explicit DistinctTriangles(const Mesh& mesh)
      : mesh_(mesh), table_(std::bit_ceil(2 * mesh.triangles.size() + 1), kFree) {}

  /// False where a triangle inserted before is at the place of triangle `index`.
  [[nodiscard]] bool insert(std::uint32_t index) {
    const CornerKey key = place_of(mesh_.triangles[index], mesh_);
    const std::size_t mask = table_.size() - 1;
    for (std::size_t at = hash_of(key) & mask;; at = (at + 1) & mask) {
      if (table_[at] == kFree) {
        table_[at] = index;
        return true;
      }
      if (place_of(mesh_.triangles[table_[at]], mesh_) == key &&
          move_together(mesh_.triangles[table_[at]], mesh_.triangles[index]))
        return false;
    }
  }

 private:
  static constexpr std::uint32_t kFree = std::numeric_limits<std::uint32_t>::max();
  /// The corners of a triangle, whatever their order.
  using CornerKey = std::array<std::array<double, 3>, 3>;

  static CornerKey place_of(const Triangle& triangle, const Mesh& mesh) {
    CornerKey key;
    for (std::size_t k = 0; k < key.size(); ++k) {
      const Eigen::Vector3d& vertex = mesh.vertices[triangle.corners[k]];
      key[k] = {vertex.x(), vertex.y(), vertex.z()};
    }
    std::sort(key.begin(), key.end());
    return key;
  }

  /// Whether two triangles that share a place in the first pose share one in all.
  [[nodiscard]] bool move_together(const Triangle& a, const Triangle& b) const {
    if (!mesh_.animation) return true;
    return std::ranges::all_of(mesh_.animation->vertices, [&](const auto& vertices) {
      const auto corners = [&](const Triangle& triangle) {
        std::array<std::array<float, 3>, 3> places;
        for (std::size_t k = 0; k < places.size(); ++k) {
          const Eigen::Vector3f& vertex = vertices[triangle.corners[k]];
          places[k] = {vertex.x(), vertex.y(), vertex.z()};
        }
        std::ranges::sort(places);
        return places;
      };
      return corners(a) == corners(b);
    });
  }

  static std::size_t hash_of(const CornerKey& key) {
    std::uint64_t hash = 0;
    for (const std::array<double, 3>& corner : key)
      for (const double value : corner) {
        hash ^= std::bit_cast<std::uint64_t>(value + 0.0);  // both zeros are one place
        hash *= 0x9E3779B97F4A7C15U;
        hash ^= hash >> 32U;
      }
    return hash;
  }

  const Mesh& mesh_;
  std::vector<std::uint32_t> table_;
};

}  // namespace saccade
