#pragma once

#include <algorithm>
#include <array>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include "simulator/scene/light/patch_lighting.h"
#include "simulator/sensor/visibility/transit.h"

namespace saccade {

/// Finds when shadows come and go where a ray intersects a plane, from its points at both ends of a
/// interval and in the middle.
class ShadowTransits {
 public:
  /// use(begin, end), as fractions of the whole, with each time during which the light is hidden; in
  /// order, and as one where triangles that hide it follow on each other.
  template <class Use>
  void find(const PartlyOccludedLight& light, const std::array<Eigen::Vector3d, 3>& points,
            const Use& use) {
    constexpr double kNeighbours = 1e-6;
    hidden_.clear();
    light.lanes.visit_candidates(points, [&](std::size_t i) {
      std::array<std::array<double, 3>, 4> forms;
      for (std::size_t k = 0; k < forms.size(); ++k)
        for (std::size_t m = 0; m < points.size(); ++m)
          forms[k][m] = light.occluders[i].forms[k].at(points[m]);
      find_intervals(forms, [&](double begin, double end) { hidden_.emplace_back(begin, end); });
      return true;
    });
    std::sort(hidden_.begin(), hidden_.end());
    for (std::size_t k = 0; k < hidden_.size();) {
      auto [begin, end] = hidden_[k];
      for (++k; k < hidden_.size() && hidden_[k].first <= end + kNeighbours; ++k)
        end = std::max(end, hidden_[k].second);
      use(begin, end);
    }
  }

 private:
  std::vector<std::pair<double, double>> hidden_;
};

}  // namespace saccade
