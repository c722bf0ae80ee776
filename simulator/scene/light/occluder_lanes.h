#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

#include <Eigen/Core>

#include "simulator/scene/intersection/triangle_bvh.h"

namespace saccade {

/// Sorts out, of many occluders at once, those whose shadow a point cannot meet along its path:
/// one of their forms stays below zero. Floats in lanes, from a point near by so that their
/// rounding is small, with margin for it.
class OccluderLanes {
 public:
  using Forms = std::array<AffineForm, 4>;
  using Points = std::array<Eigen::Vector3d, 3>;

  OccluderLanes() = default;
  /// For points within `reach_m` of `origin`.
  OccluderLanes(const Eigen::Vector3d& origin, double reach_m)
      : origin_(origin), reach_m_(reach_m) {}

  void add(const Forms& forms) {
    if (count_ % kLanes == 0) blocks_.emplace_back();
    Block& block = blocks_.back();
    const std::size_t lane = count_++ % kLanes;
    for (std::size_t k = 0; k < forms.size(); ++k) {
      const double offset = forms[k].at(origin_);
      const double size = forms[k].gradient.norm() * reach_m_ + std::abs(offset);
      block.x[k][lane] = static_cast<float>(forms[k].gradient.x());
      block.y[k][lane] = static_cast<float>(forms[k].gradient.y());
      block.z[k][lane] = static_cast<float>(forms[k].gradient.z());
      block.offset[k][lane] = static_cast<float>(offset);
      block.margin[k][lane] = static_cast<float>(kRounding * size);
    }
  }

  /// use(i), counted in the order of add(), until it returns false, for those that a point may meet
  /// that goes along the parabola through its offsets at both ends and half points.
  template <class Use>
  void visit_candidates(const Points& points, const Use& use) const {
    std::array<std::array<float, 3>, 3> offsets;
    for (std::size_t m = 0; m < points.size(); ++m)
      for (std::size_t c = 0; c < 3; ++c)
        offsets[m][c] = static_cast<float>(points[m][static_cast<Eigen::Index>(c)] -
                                           origin_[static_cast<Eigen::Index>(c)]);
    Lanes is_beside;
    for (std::size_t first = 0; first < count_; first += kLanes) {
      test(blocks_[first / kLanes], offsets, is_beside);
      for (std::size_t lane = 0; lane < std::min(kLanes, count_ - first); ++lane)
        if (is_beside[lane] == 0 && !use(first + lane)) return;
    }
  }

 private:
  static constexpr std::size_t kLanes = 16;
  static constexpr double kRounding = 1e-6;
  using Lanes = std::array<float, kLanes>;

  struct Block {
    std::array<Lanes, 4> x{}, y{}, z{}, offset{}, margin{};
  };

  static void test(const Block& block, const std::array<std::array<float, 3>, 3>& offsets,
                   Lanes& is_beside) {
    for (std::size_t lane = 0; lane < kLanes; ++lane) {
      float beside = 0;
      for (std::size_t k = 0; k < 4; ++k) {
        const auto at = [&](const std::array<float, 3>& p) {
          return block.x[k][lane] * p[0] + block.y[k][lane] * p[1] + block.z[k][lane] * p[2] +
                 block.offset[k][lane];
        };
        const float from = at(offsets[0]);
        const float middle = at(offsets[1]);
        const float to = at(offsets[2]);
        const float control = 2 * middle - 0.5F * (from + to);
        const float high = std::max(std::max(from, middle), std::max(to, control));
        beside = high < -block.margin[k][lane] ? 1.0F : beside;
      }
      is_beside[lane] = beside;
    }
  }

  Eigen::Vector3d origin_ = Eigen::Vector3d::Zero();
  double reach_m_ = 0;
  std::vector<Block> blocks_;
  std::size_t count_ = 0;
};

}  // namespace saccade
