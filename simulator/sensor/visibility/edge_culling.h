#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <vector>

#include "simulator/sensor/visibility/transit.h"

namespace saccade {

/// Sorts out, of many triangles at once, those that a ray cannot meet during an interval of time:
/// it is outside one of their edges all the time. The forms along the ray are parabolas, as in
/// TriangleRayBounds; floats in lanes, whose rounding is far below the margin.
class EdgeCulling {
 public:
  /// Drops all triangles. Of those that follow, what is nearer to an edge than `margin` of the image
  /// plane does not count as outside.
  void clear(double margin) {
    margin_ = static_cast<float>(margin);
    count_ = 0;
  }

  void add(const TransitTriangle& triangle) {
    if (count_ % kLanes == 0 && count_ / kLanes == blocks_.size()) blocks_.emplace_back();
    Block& block = blocks_[count_ / kLanes];
    const std::size_t lane = count_++ % kLanes;
    for (std::size_t m = 0; m < 3; ++m) {
      block.planes[m].set(lane, triangle.at[m].w);
      for (std::size_t k = 0; k < 3; ++k) block.edges[k][m].set(lane, triangle.at[m].edges[k]);
    }
    for (std::size_t k = 0; k < 3; ++k)
      block.reach[k][lane] = margin_ * static_cast<float>(triangle.at[1].edges[k].head<2>().norm());
  }

  /// use(i) for those, counted in the order of add(), that the ray `direction` may meet.
  template <class Use>
  void visit_candidates(const Eigen::Vector3d& direction, const Use& use) const {
    const std::array<float, 3> ray{static_cast<float>(direction.x()),
                                   static_cast<float>(direction.y()),
                                   static_cast<float>(direction.z())};
    Lanes is_outside;
    for (std::size_t first = 0; first < count_; first += kLanes) {
      test(blocks_[first / kLanes], ray, is_outside);
      for (std::size_t lane = 0; lane < std::min(kLanes, count_ - first); ++lane)
        if (is_outside[lane] == 0) use(first + lane);
    }
  }

 private:
  static constexpr std::size_t kLanes = 16;
  using Lanes = std::array<float, kLanes>;

  struct Forms {
    Lanes x, y, z;

    void set(std::size_t lane, const Eigen::Vector3d& form) {
      x[lane] = static_cast<float>(form.x());
      y[lane] = static_cast<float>(form.y());
      z[lane] = static_cast<float>(form.z());
    }
    [[nodiscard]] float at(std::size_t lane, const std::array<float, 3>& ray) const {
      return x[lane] * ray[0] + y[lane] * ray[1] + z[lane] * ray[2];
    }
  };
  struct Block {
    std::array<Forms, 3> planes{};                ///< at both ends and in the middle
    std::array<std::array<Forms, 3>, 3> edges{};  ///< the same of each edge
    std::array<Lanes, 3> reach{};
  };

  static void test(const Block& block, const std::array<float, 3>& ray, Lanes& is_outside) {
    for (std::size_t lane = 0; lane < kLanes; ++lane) {
      const auto bounds = [&](const std::array<Forms, 3>& forms, float& low, float& high) {
        const float from = forms[0].at(lane, ray);
        const float middle = forms[1].at(lane, ray);
        const float to = forms[2].at(lane, ray);
        const float control = 2 * middle - 0.5F * (from + to);
        low = std::min(std::min(from, middle), std::min(to, control));
        high = std::max(std::max(from, middle), std::max(to, control));
      };
      // Turned to the camera, the triangle lies where all forms are above zero, else below.
      float low, high;
      bounds(block.planes, low, high);
      float is_beside_front = high > 0 ? 0.0F : 1.0F;
      float is_beside_back = low < 0 ? 0.0F : 1.0F;
      for (std::size_t k = 0; k < 3; ++k) {
        bounds(block.edges[k], low, high);
        is_beside_front = high < -block.reach[k][lane] ? 1.0F : is_beside_front;
        is_beside_back = low > block.reach[k][lane] ? 1.0F : is_beside_back;
      }
      is_outside[lane] = is_beside_front * is_beside_back;
    }
  }

  float margin_ = 0;
  std::vector<Block> blocks_;
  std::size_t count_ = 0;
};

}  // namespace saccade
