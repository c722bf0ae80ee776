#include "simulator/scene/intersection/triangle_bvh.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/check.h"

namespace saccade {
namespace {

constexpr std::uint32_t kLeaf = 4;
/// Below this boxes are halved by number, so that the tree fits the stack that visits it.
constexpr int kDeepest = 30;
constexpr std::size_t kMaxFrusta = 5;
/// Fractions of the size of a box that float coordinates are trusted to.
constexpr double kRounding = 1e-6;

/// Three times the centre.
Eigen::Vector3f centre_of(const Corners& corners) { return corners[0] + corners[1] + corners[2]; }

struct Interval {
  double low, high;
};

/// The four sides of the frusta and the plane through the eye across them, not negative inside,
/// and the half space in front.
class Region {
 public:
  Region(std::span<const Frustum> frusta, const AffineForm& front)
      : count_(frusta.size()), front_(front) {
    SACCADE_CHECK(!frusta.empty() && frusta.size() <= kMaxFrusta);
    for (std::size_t m = 0; m < count_; ++m) {
      const Frustum& frustum = frusta[m];
      const Eigen::Vector3d axis = frustum.corners[0] + frustum.corners[2];
      for (std::size_t k = 0; k < 4; ++k) {
        Eigen::Vector3d normal =
            frustum.corners[k].cross(frustum.corners[(k + 1) % 4]).normalized();
        if (normal.dot(axis) < 0) normal = -normal;
        sides_[k][m] = {normal, -normal.dot(frustum.eye)};
      }
      sides_[4][m] = {axis, -axis.dot(frustum.eye)};
    }
    for (std::size_t k = 0; k < kLanes; ++k) {
      const AffineForm form = k < sides_.size()    ? sides_[k][0]
                              : k == sides_.size() ? front_
                                                   : AffineForm{Eigen::Vector3d::Zero(), 1};
      for (std::size_t axis = 0; axis < 3; ++axis)
        lanes_[axis][k] = form.gradient[static_cast<Eigen::Index>(axis)];
      lanes_[3][k] = form.offset;
    }
  }

  /// Whether there is one frustum, for which excludes_one() is quicker.
  [[nodiscard]] bool is_one() const { return count_ == 1; }

  [[nodiscard]] bool excludes_one(const Eigen::AlignedBox3f& box) const {
    const Eigen::Vector3d middle = box.center().cast<double>();
    const Eigen::Vector3d half = box.sizes().cast<double>() * (0.5 + kRounding);
    unsigned outside = 0;
    for (std::size_t k = 0; k < kLanes; ++k) {
      const double high = lanes_[0][k] * middle.x() + lanes_[1][k] * middle.y() +
                          lanes_[2][k] * middle.z() + lanes_[3][k] +
                          std::abs(lanes_[0][k]) * half.x() + std::abs(lanes_[1][k]) * half.y() +
                          std::abs(lanes_[2][k]) * half.z();
      outside |= high < 0 ? 1U : 0U;
    }
    return outside != 0;
  }

  [[nodiscard]] bool excludes_one(const Corners& corners) const {
    std::array<unsigned, kLanes> inside{};
    for (const Eigen::Vector3f& corner : corners) {
      const Eigen::Vector3d at = corner.cast<double>();
      for (std::size_t k = 0; k < kLanes; ++k)
        inside[k] |=
            lanes_[0][k] * at.x() + lanes_[1][k] * at.y() + lanes_[2][k] * at.z() + lanes_[3][k] >=
                    0
                ? 1U
                : 0U;
    }
    unsigned all = 1;
    for (const unsigned each : inside) all &= each;
    return all == 0;
  }

  /// All sides and the front, as bits.
  static constexpr std::uint32_t kAll = 0x3f;

  /// Whether one and the same of `sides` keeps a set of points out at all times. `range(form)`: the
  /// least and the greatest value of an affine form over the set. Drops from `sides` those that
  /// keep none of its points out.
  template <class Range>
  [[nodiscard]] bool excludes(const Range& range, std::uint32_t& sides) const {
    if ((sides & kFront) != 0) {
      const Interval values = range(front_);
      if (values.high <= 0) return true;
      if (values.low > 0) sides &= ~kFront;
    }
    for (std::size_t k = 0; k < sides_.size(); ++k) {
      const std::uint32_t bit = 1U << k;
      if ((sides & bit) == 0) continue;
      bool outside = true;
      for (std::size_t m = 0; m < count_ && outside; ++m) {
        const Interval values = range(sides_[k][m]);
        outside = values.high < 0;
        if (values.low >= 0) sides &= ~bit;
      }
      if (outside) return true;
    }
    return false;
  }

 private:
  static constexpr std::uint32_t kFront = 0x20;
  static constexpr std::size_t kLanes = 8;

  std::size_t count_;
  std::array<std::array<AffineForm, kMaxFrusta>, 5> sides_;
  AffineForm front_;
  /// The sides of the first frustum and the front, coefficient by coefficient, for vectors.
  std::array<std::array<double, kLanes>, 4> lanes_;
};

}  // namespace

TriangleBvh::TriangleBvh(std::initializer_list<TriangleRun> runs) {
  std::size_t count = 0;
  for (const TriangleRun& run : runs) count += run.corners.size();
  triangles_.reserve(count);
  for (const TriangleRun& run : runs) {
    TriangleId id = run.first;
    for (const Corners& corners : run.corners) triangles_.push_back({corners, id++});
  }
  nodes_.reserve(triangles_.size());
  if (!triangles_.empty()) build(0, static_cast<std::uint32_t>(triangles_.size()));
}

/// Where the surfaces of both parts' boxes times their triangles are least, of some planes across
/// the longest extent of the centres.
std::uint32_t TriangleBvh::divide(std::span<Item> triangles, const Eigen::AlignedBox3f& centres) {
  constexpr std::size_t kBins = 16;
  struct Bin {
    Eigen::AlignedBox3f box;
    std::uint32_t count = 0;

    void add(const Bin& other) {
      box.extend(other.box);
      count += other.count;
    }
    [[nodiscard]] float cost() const {
      const Eigen::Vector3f size = box.sizes();
      return static_cast<float>(count) *
             (size.x() * size.y() + size.y() * size.z() + size.z() * size.x());
    }
  };
  Eigen::Index axis = 0;
  const float extent = centres.sizes().maxCoeff(&axis);
  const auto bin_of = [&](const Item& occluder) {
    const float fraction = (centre_of(occluder.corners)[axis] - centres.min()[axis]) / extent;
    return std::min(static_cast<std::size_t>(fraction * static_cast<float>(kBins)), kBins - 1);
  };
  const auto half = static_cast<std::uint32_t>(triangles.size() / 2);
  if (!(extent > 0)) return half;
  std::array<Bin, kBins> bins;
  for (const Item& occluder : triangles) {
    Bin& bin = bins[bin_of(occluder)];
    for (const Eigen::Vector3f& corner : occluder.corners) bin.box.extend(corner);
    ++bin.count;
  }
  std::array<float, kBins> after{};  // cost of the bins from here on
  Bin sum;
  for (std::size_t k = kBins; k-- > 1;) {
    sum.add(bins[k]);
    after[k] = sum.count == 0 ? 0 : sum.cost();
  }
  sum = bins[0];
  std::size_t best = 1;
  float least = std::numeric_limits<float>::infinity();
  for (std::size_t k = 1; k < kBins; ++k) {
    const float cost = sum.cost() + after[k];
    if (cost < least) {
      least = cost;
      best = k;
    }
    sum.add(bins[k]);
  }
  const auto middle = std::partition(triangles.begin(), triangles.end(),
                                     [&](const Item& each) { return bin_of(each) < best; });
  return static_cast<std::uint32_t>(middle - triangles.begin());
}

void TriangleBvh::build(std::uint32_t first, std::uint32_t count, int depth) {
  const std::size_t index = nodes_.size();
  nodes_.emplace_back();
  Eigen::AlignedBox3f box, centres;
  const auto begin = triangles_.begin() + first;
  const auto end = begin + count;
  for (auto triangle = begin; triangle != end; ++triangle) {
    for (const Eigen::Vector3f& corner : triangle->corners) box.extend(corner);
    centres.extend(centre_of(triangle->corners));
  }
  nodes_[index].box = box;
  if (count <= kLeaf) {
    nodes_[index].first = first;
    nodes_[index].count = count;
    return;
  }
  const std::uint32_t half = depth < kDeepest ? divide({begin, end}, centres) : count / 2;
  build(first, half, depth + 1);
  nodes_[index].first = static_cast<std::uint32_t>(nodes_.size());
  build(first + half, count - half, depth + 1);
}

template <class Use>
void TriangleBvh::visit(std::span<const Frustum> frusta, const AffineForm& front,
                        const Use& use) const {
  if (nodes_.empty()) return;
  const Region region(frusta, front);
  const bool is_one = region.is_one();
  const auto over_box = [](const Eigen::AlignedBox3f& box) {
    const Eigen::Vector3d middle = box.center().cast<double>();
    const Eigen::Vector3d half = box.sizes().cast<double>() * (0.5 + kRounding);
    return [middle, half](const AffineForm& form) -> Interval {
      const double at_middle = form.at(middle);
      const double reach = form.gradient.cwiseAbs().dot(half);
      return {at_middle - reach, at_middle + reach};
    };
  };
  const auto over_triangle = [](const Corners& corners) {
    return [&corners](const AffineForm& form) -> Interval {
      const auto [low, high] =
          std::minmax({form.at(corners[0].cast<double>()), form.at(corners[1].cast<double>()),
                       form.at(corners[2].cast<double>())});
      return {low, high};
    };
  };
  struct Open {
    std::uint32_t node;
    std::uint32_t sides;  ///< that may keep some of it out
  };
  std::array<Open, 64> stack;
  std::size_t height = 0;
  stack[height++] = {0, Region::kAll};
  while (height > 0) {
    auto [index, sides] = stack[--height];
    const Node& node = nodes_[index];
    if (is_one ? region.excludes_one(node.box) : region.excludes(over_box(node.box), sides))
      continue;
    if (node.count == 0) {
      stack[height++] = {node.first, sides};
      stack[height++] = {index + 1, sides};
      continue;
    }
    for (std::uint32_t k = node.first; k < node.first + node.count; ++k) {
      std::uint32_t left = sides;
      const Corners& corners = triangles_[k].corners;
      const bool is_outside =
          is_one ? region.excludes_one(corners) : region.excludes(over_triangle(corners), left);
      if (!is_outside && !use(triangles_[k].id)) return;
    }
  }
}

bool TriangleBvh::may_intersect(std::span<const Frustum> frusta, const AffineForm& front) const {
  bool any = false;
  visit(frusta, front, [&](TriangleId) {
    any = true;
    return false;
  });
  return any;
}

bool TriangleBvh::collect(std::span<const Frustum> frusta, const AffineForm& front,
                          std::size_t most, std::vector<TriangleId>& found) const {
  bool all = true;
  visit(frusta, front, [&](TriangleId id) {
    all = found.size() < most;
    if (all) found.push_back(id);
    return all;
  });
  return all;
}

}  // namespace saccade
