#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "core/rigid3.h"
#include "core/spline/spline.h"
#include "core/trajectory.h"

namespace saccade {

/// Evenly spaced knots of a cubic B-spline. Segment i, `spacing_s` long, depends on the controls
/// i .. i + 3; there are segments + 3 controls.
struct SplineKnots {
  double start_s = 0;
  double spacing_s = 1;  ///< > 0
  std::size_t segments = 1;

  /// Whole segments that fill [start_s, end_s], each about `spacing_s` long.
  [[nodiscard]] static SplineKnots over(double start_s, double end_s, double spacing_s);

  [[nodiscard]] std::size_t controls() const { return segments + 3; }
  [[nodiscard]] double end_s() const { return start_s + static_cast<double>(segments) * spacing_s; }
  /// When a control has its greatest weight.
  [[nodiscard]] double time_s(std::size_t control) const {
    return start_s + (static_cast<double>(control) - 1) * spacing_s;
  }

  /// The basis functions that are not zero at an instant, and their controls.
  struct LocalBasis {
    std::size_t first = 0;   ///< of the four controls
    Eigen::Array4d basis;    ///< cumulative: B_1 .. B_3 and a zero
    Eigen::Vector4d weight;  ///< of the four, sum 1: 1 - B_1, B_1 - B_2, B_2 - B_3, B_3
  };
  /// The time is clamped to [start_s, end_s].
  [[nodiscard]] LocalBasis at(double t_s) const;
};

/// A spline's pose at one instant over its four control poses, and how it changes with them:
/// position by weight_k of each control's, orientation to the right,
///   R -> R Exp(rotation_jacobian d)  where  R_k -> R_k Exp(d_k).
struct PoseOverControls {
  Rigid3 world_from_body;
  Eigen::Matrix<double, 3, 12> rotation_jacobian;
};
[[nodiscard]] PoseOverControls pose_over(const SplineKnots::LocalBasis& local,
                                         const std::array<Rigid3, 4>& controls);

/// Control poses of a spline over knots.
struct SplineControls {
  SplineKnots knots;
  std::vector<Rigid3> poses;  ///< knots.controls()

  /// Those of Spline::smooth().
  [[nodiscard]] static SplineControls smooth(std::span<const StampedPose> poses,
                                             double knot_spacing_s);
  [[nodiscard]] Spline spline() const {
    return Spline::from_control_poses(poses, knots.start_s, knots.spacing_s);
  }
};

}  // namespace saccade
