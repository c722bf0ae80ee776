#pragma once

#include <Eigen/Core>

#include "core/camera.h"
#include "core/rigid3.h"

namespace saccade {

/// The event-to-edge residual, in the edge's view (docs/odometry.md, "The window adjustment"); its
/// noise model is edge_noise.h:
///   r = (n . (x(rho) - e) - c - m t . (x(rho) - e) - h l) / g,   g = (1 - rho o_z) / (R q)_z,
///   x(rho) = K (a + rho (o_xy - o_z a)),   a = (R q)_xy / (R q)_z,   (R, o) = view_from_camera.
/// g is how much larger a pixel of the sensor is in the view: it is on the sensor that events
/// scatter, and a residual in the view would be made small by any motion that shrinks the picture.
/// With q = K^-1 u the event's ray, rho the edge's inverse depth, c its offset, m its tilt and h
/// the shift [px] per contrast of lag l: of refine depth and the batch adjustment l = p, so that h is the
/// ON/OFF shift; of the window adjustment also that between successive events of a polarity run.
struct EdgeObservation {
  Rigid3 view_from_camera;  ///< at the event's time, before any correction
  Eigen::Vector3d ray;      ///< q, z = 1
  /// What h is multiplied by: the polarity p, +1 or -1, or p times the contrasts by which the
  /// brightness had changed (polarity_runs.h).
  double lag = 0;
  Eigen::Vector2d pixel;   ///< e, in the view
  Eigen::Vector2d normal;  ///< n, unit
};

/// The unknowns of an edge in the order rho [1/m], c [px], m, h [px].
using EdgeUnknowns = Eigen::Vector4d;

/// The residual of an event and a fixed camera: numerator and g are linear in the unknowns.
struct EdgeLine {
  double across_px = 0, across_by_rho = 0;  ///< n . (x(rho) - e) at rho = 0, and its change
  double along_px = 0, along_by_rho = 0;    ///< t . (x(rho) - e)
  double origin_z = 0;                      ///< o_z [m]
  double forward = 0;                       ///< (R q)_z; not above 0: the ray leads away
  double lag = 0;

  /// g; not above 0: the edge is behind the camera.
  [[nodiscard]] double magnification(double rho) const { return (1 - rho * origin_z) / forward; }
  /// n . (x - e) - c - m t . (x - e) - h l.
  [[nodiscard]] double residual_in_view_px(const EdgeUnknowns& edge) const {
    return across_px + edge[0] * across_by_rho - edge[1] -
           edge[2] * (along_px + edge[0] * along_by_rho) - edge[3] * lag;
  }
  /// The derivative of residual_in_view_px / magnification by the unknowns.
  [[nodiscard]] Eigen::Matrix<double, 1, 4> by_edge(const EdgeUnknowns& edge) const;
};

[[nodiscard]] EdgeLine line_of(const EdgeObservation& observation, const PinholeCamera& camera);

/// The residual's derivatives by the unknowns and by a small motion of the camera,
/// view_from_camera exp(xi).
struct EdgeDerivatives {
  Eigen::Matrix<double, 1, 6> motion;
  Eigen::Matrix<double, 1, 4> edge;
};

/// The residual [px] after the camera has moved by `motion` (v, w); `derivatives`: may be null. A
/// ray that does not reach in front of the view is NaN.
[[nodiscard]] double edge_residual(const EdgeObservation& observation, const PinholeCamera& camera,
                                   const Twist& motion, const EdgeUnknowns& edge,
                                   EdgeDerivatives* derivatives);

}  // namespace saccade
