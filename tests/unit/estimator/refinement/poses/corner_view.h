#pragma once

#include <cmath>
#include <vector>

#include "estimator/tracking/intensity_map.h"
#include "estimator/tracking/reference_view.h"
#include "tests/support/planar_world.h"

namespace saccade::testing {

/// A small camera before a corner with a plane in front of it, its events, and the map of its first
/// view.
struct CornerView {
  static constexpr double kEnd_s = 0.3;
  static constexpr double kContrast = 0.12;

  PlanarWorld world = corner_world(120, 90);
  Events events = world.simulate(motion, 0, kEnd_s, 1e-3, kContrast);
  IntensityMap map = first_view();

  static Rigid3 motion(double t_s) {
    return {so3_exp({0.1 * t_s, -0.2 * t_s, 0.3 * t_s}),
            {0.5 * t_s, 0.1 * std::sin(6 * t_s), 0.2 * t_s}};
  }

  [[nodiscard]] IntensityMap first_view() const {
    ReferenceView view;
    view.log_intensity = world.log_intensity(motion(0));
    view.depth = world.depth(motion(0));
    view.world_from_reference = motion(0);
    const std::vector<ReferenceView> views{view};
    return {world.camera(), views, IntensityMap::kEdgeBlur_px};
  }

  /// The true path, moved by `share` of half a pixel here and there.
  [[nodiscard]] std::vector<StampedPose> disturbed(double share) const {
    std::vector<StampedPose> poses;
    for (int i = 0; i <= 100; ++i) {
      const double t_s = kEnd_s * i / 100;
      const double away = share * std::sin(15 * t_s + 0.5);
      const Twist error = (Twist() << 0.008, -0.006, 0.01, 0.002, 0.004, -0.004).finished();
      poses.push_back({t_s, motion(t_s) * Rigid3::exp(away * error)});
    }
    return poses;
  }
};

/// Made once.
inline const CornerView& corner_view() {
  static const CornerView view;
  return view;
}

}  // namespace saccade::testing
