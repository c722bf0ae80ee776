#pragma once

#include <cstdint>
#include <initializer_list>
#include <span>
#include <vector>

#include <Eigen/Geometry>

#include "simulator/scene/intersection/embree_scene.h"
#include "simulator/scene/scene.h"

namespace saccade {

/// a . p + b of a point p.
struct AffineForm {
  Eigen::Vector3d gradient = Eigen::Vector3d::Zero();
  double offset = 0;

  [[nodiscard]] double at(const Eigen::Vector3d& point) const {
    return gradient.dot(point) + offset;
  }
};

/// A bounding volume hierarchy of triangles, to prove that none of them can become visible.
/// Conservative: a triangle counts as long as no side of the frusta separates it. Thread-safe once
/// built.
class TriangleBvh {
 public:
  explicit TriangleBvh(std::initializer_list<TriangleRun> runs);

  /// Whether some triangle may reach into a frustum that moves evenly through those of
  /// `frusta`, above zero of `front`.
  [[nodiscard]] bool may_intersect(std::span<const Frustum> frusta, const AffineForm& front) const;

  /// Adds all such triangles to `found`, in a fixed order; false where it would hold more than
  /// `most`.
  [[nodiscard]] bool collect(std::span<const Frustum> frusta, const AffineForm& front,
                             std::size_t most, std::vector<TriangleId>& found) const;

 private:
  struct Item {
    Corners corners;
    TriangleId id;
  };

  /// use(id) for all such triangles, until it returns false.
  template <class Use>
  void visit(std::span<const Frustum> frusta, const AffineForm& front, const Use& use) const;

  /// A box; its children follow, or as a leaf it holds triangles first..first + count.
  struct Node {
    Eigen::AlignedBox3f box;
    std::uint32_t first = 0;  ///< of a leaf its first triangle, else its second child
    std::uint32_t count = 0;  ///< 0: no leaf; the first child is the next node
  };

  void build(std::uint32_t first, std::uint32_t count, int depth = 0);
  /// Brings the triangles of both children together; returns the number in the first.
  [[nodiscard]] static std::uint32_t divide(std::span<Item> triangles,
                                            const Eigen::AlignedBox3f& centres);

  std::vector<Item> triangles_;  ///< in the order of the leaves
  std::vector<Node> nodes_;
};

}  // namespace saccade
