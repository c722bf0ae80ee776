#include "simulator/scene/occluder_tree.h"

#include <algorithm>
#include <cmath>

#include "core/check.h"

namespace saccade {
namespace {

constexpr std::uint32_t kLeaf = 4;
constexpr std::size_t kMostPyramids = 4;
/// Shares of the size of a box that float coordinates are trusted to.
constexpr double kRounding = 1e-6;

/// The four sides of the pyramids and the plane through the eye across them, not negative inside,
/// and the half space in front.
class Region {
 public:
  Region(std::span<const SightPyramid> sweep, const AffineForm& front)
      : count_(sweep.size()), front_(front) {
    SACCADE_CHECK(!sweep.empty() && sweep.size() <= kMostPyramids);
    for (std::size_t m = 0; m < count_; ++m) {
      const SightPyramid& pyramid = sweep[m];
      const Eigen::Vector3d axis = pyramid.corners[0] + pyramid.corners[2];
      for (std::size_t k = 0; k < 4; ++k) {
        Eigen::Vector3d normal =
            pyramid.corners[k].cross(pyramid.corners[(k + 1) % 4]).normalized();
        if (normal.dot(axis) < 0) normal = -normal;
        sides_[k][m] = {normal, -normal.dot(pyramid.eye)};
      }
      sides_[4][m] = {axis, -axis.dot(pyramid.eye)};
    }
  }

  /// Whether one and the same side keeps a set of points out at all times, or the front does.
  /// `highest(form)`: the greatest value of an affine form over the set.
  template <class Highest>
  [[nodiscard]] bool excludes(const Highest& highest) const {
    if (highest(front_) <= 0) return true;
    for (const auto& side : sides_) {
      bool outside = true;
      for (std::size_t m = 0; m < count_ && outside; ++m) outside = highest(side[m]) < 0;
      if (outside) return true;
    }
    return false;
  }

 private:
  std::size_t count_;
  std::array<std::array<AffineForm, kMostPyramids>, 5> sides_;
  AffineForm front_;
};

}  // namespace

OccluderTree::OccluderTree(std::span<const Corners> triangles, std::span<const TriangleId> ids) {
  SACCADE_CHECK(triangles.size() == ids.size());
  triangles_.reserve(triangles.size());
  for (std::size_t i = 0; i < ids.size(); ++i) triangles_.push_back({triangles[i], ids[i]});
  nodes_.reserve(triangles_.size());
  if (!triangles_.empty()) build(0, static_cast<std::uint32_t>(triangles_.size()));
}

void OccluderTree::build(std::uint32_t first, std::uint32_t count) {
  const std::size_t index = nodes_.size();
  nodes_.emplace_back();
  Eigen::AlignedBox3f box, centres;
  const auto begin = triangles_.begin() + first;
  const auto end = begin + count;
  const auto centre = [](const Occluder& occluder) -> Eigen::Vector3f {
    return occluder.corners[0] + occluder.corners[1] + occluder.corners[2];
  };
  for (auto triangle = begin; triangle != end; ++triangle) {
    for (const Eigen::Vector3f& corner : triangle->corners) box.extend(corner);
    centres.extend(centre(*triangle));
  }
  nodes_[index].box = box;
  if (count <= kLeaf) {
    nodes_[index].first = first;
    nodes_[index].count = count;
    return;
  }
  Eigen::Index axis = 0;
  centres.sizes().maxCoeff(&axis);
  const std::uint32_t half = count / 2;
  std::nth_element(begin, begin + half, end, [&](const Occluder& a, const Occluder& b) {
    return centre(a)[axis] < centre(b)[axis];
  });
  build(first, half);
  nodes_[index].first = static_cast<std::uint32_t>(nodes_.size());
  build(first + half, count - half);
}

template <class Use>
void OccluderTree::visit(std::span<const SightPyramid> sweep, const AffineForm& front,
                         const Use& use) const {
  if (nodes_.empty()) return;
  const Region region(sweep, front);
  const auto over_box = [](const Eigen::AlignedBox3f& box) {
    const Eigen::Vector3d middle = box.center().cast<double>();
    const Eigen::Vector3d half = box.sizes().cast<double>() * (0.5 + kRounding);
    return [middle, half](const AffineForm& form) {
      return form.at(middle) + form.gradient.cwiseAbs().dot(half);
    };
  };
  const auto over_triangle = [](const Corners& corners) {
    return [&corners](const AffineForm& form) {
      return std::max({form.at(corners[0].cast<double>()), form.at(corners[1].cast<double>()),
                       form.at(corners[2].cast<double>())});
    };
  };
  std::array<std::uint32_t, 64> stack;
  std::size_t height = 0;
  stack[height++] = 0;
  while (height > 0) {
    const std::uint32_t index = stack[--height];
    const Node& node = nodes_[index];
    if (region.excludes(over_box(node.box))) continue;
    if (node.count == 0) {
      stack[height++] = node.first;
      stack[height++] = index + 1;
      continue;
    }
    for (std::uint32_t k = node.first; k < node.first + node.count; ++k)
      if (!region.excludes(over_triangle(triangles_[k].corners)) && !use(triangles_[k].id)) return;
  }
}

bool OccluderTree::may_show(std::span<const SightPyramid> sweep, const AffineForm& front) const {
  bool any = false;
  visit(sweep, front, [&](TriangleId) {
    any = true;
    return false;
  });
  return any;
}

bool OccluderTree::collect(std::span<const SightPyramid> sweep, const AffineForm& front,
                           std::size_t most, std::vector<TriangleId>& found) const {
  bool all = true;
  visit(sweep, front, [&](TriangleId id) {
    all = found.size() < most;
    if (all) found.push_back(id);
    return all;
  });
  return all;
}

}  // namespace saccade
