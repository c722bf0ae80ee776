#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <vector>

#include <Eigen/Core>

#include "simulator/scene/light/occluder_lanes.h"
#include "simulator/scene/visibility/triangle_bvh.h"
#include "simulator/scene/scene.h"

namespace saccade {

/// A triangle between a lamp and a patch of surface. It keeps the lamp's light from a point where
/// all its forms are above zero: three for its edges, the last for its plane before the point. All
/// are affine for the light of a far lamp as well as of a near one.
struct ShadowCaster {
  std::array<AffineForm, 4> forms;
  TriangleId triangle;

  [[nodiscard]] bool hides(const Eigen::Vector3d& point) const {
    return std::all_of(forms.begin(), forms.end(),
                       [&](const AffineForm& form) { return form.at(point) > 0; });
  }
};

/// A lamp whose light some triangles may keep from parts of a patch.
struct DoubtfulLamp {
  LampSet bit;
  std::vector<ShadowCaster> casters;
  CasterLanes lanes;  ///< of them, in their order
};

/// Which lamps light the points of a patch of a triangle that stands still.
struct PatchLight {
  /// From a point of the triangle to where its ways to the lamps begin.
  Eigen::Vector3d lift = Eigen::Vector3d::Zero();
  LampSet proven = 0;  ///< light all of the patch
  std::vector<DoubtfulLamp> doubtful;

  /// Of a point of the patch, in double precision.
  [[nodiscard]] LampSet lamps_at(const Eigen::Vector3d& point) const;
};

}  // namespace saccade
