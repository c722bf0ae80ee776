#pragma once

#include <algorithm>
#include <array>
#include <vector>

#include <Eigen/Core>

#include "simulator/scene/intersection/triangle_bvh.h"
#include "simulator/scene/light/occluder_lanes.h"
#include "simulator/scene/scene.h"

namespace saccade {

/// A triangle between a light and a patch of surface. It keeps the light's light from a point where
/// all its forms are above zero: three for its edges, the last for its plane before the point. All
/// are affine for the light of a far light as well as of a near one.
struct Occluder {
  std::array<AffineForm, 4> forms;
  TriangleId triangle;

  [[nodiscard]] bool occludes(const Eigen::Vector3d& point) const {
    return std::all_of(forms.begin(), forms.end(),
                       [&](const AffineForm& form) { return form.at(point) > 0; });
  }
};

/// A light whose light some triangles may keep from parts of a patch.
struct PartlyOccludedLight {
  LightSet bit;
  std::vector<Occluder> occluders;
  OccluderLanes lanes;  ///< of them, in their order
};

/// Which lights light the points of a patch of a triangle that is static.
struct PatchLighting {
  /// From a point of the triangle to where its paths to the lights begin.
  Eigen::Vector3d shadow_offset = Eigen::Vector3d::Zero();
  LightSet unoccluded = 0;  ///< light all of the patch
  std::vector<PartlyOccludedLight> partly_occluded;

  /// Of a point of the patch, in double precision.
  [[nodiscard]] LightSet lights_at(const Eigen::Vector3d& point) const;
};

}  // namespace saccade
