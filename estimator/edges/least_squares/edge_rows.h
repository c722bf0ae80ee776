#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include <Eigen/Core>

#include "core/camera.h"
#include "estimator/edges/edge_residual.h"
#include "estimator/lanes.h"

namespace saccade {

/// Events of one edge that are worked on together, one in each lane.
inline constexpr std::size_t kEventLanes = kDoubleLanes;

/// An event of an edge, by the unknowns that it depends on. The path is moved at the event's time by
///   xi = sum over k of weight_k xi_(first + k),
/// of `kSupport` neighbouring unknown twists, and the edge's offset is c + run_offset k, where the
/// edge has a fifth unknown k.
template <int kSupport>
struct BundleEvent {
  EdgeObservation observation;
  double run_offset = 0;
  double sigma_px = 1;
  std::size_t first = 0;
  Eigen::Matrix<double, kSupport, 1> weight;
};

/// kEventLanes events of one edge, packed. A lane without an event has an inverse sigma of 0.
template <int kSupport>
struct EventLanes {
  std::array<DoubleLanes, 9> rotation{};  ///< of view_from_camera, row by row
  std::array<DoubleLanes, 3> origin{};    ///< its translation [m]
  std::array<DoubleLanes, 2> ray{};       ///< q; q_z = 1
  DoubleLanes lag{}, run_offset{}, inverse_sigma{};
  std::array<DoubleLanes, kSupport> weight{};
  std::array<std::uint32_t, kEventLanes> first{};

  EventLanes();
  void set(std::size_t lane, const BundleEvent<kSupport>& event);
  [[nodiscard]] BundleEvent<kSupport> event(std::size_t lane, const Eigen::Vector2d& pixel,
                                            const Eigen::Vector2d& normal) const;
  [[nodiscard]] bool holds(std::size_t lane) const { return inverse_sigma[lane] > 0; }
};

/// An edge as its events' residuals see it. `unknowns`: rho, c, m, h and, where there are five, k.
template <int kUnknowns>
struct EdgeState {
  Eigen::Vector2d pixel, normal;
  Eigen::Matrix<double, kUnknowns, 1> unknowns;
};

/// Residuals over their sigma and, scaled alike, their derivatives by the path's twist at the event
/// and by the edge's unknowns.
template <int kUnknowns>
struct RowLanes {
  DoubleLanes residual;
  std::array<DoubleLanes, 6> by_motion;
  std::array<DoubleLanes, kUnknowns> by_edge;
};

/// edge_residual() of kEventLanes events at once, over their sigma, with the path moved by `motion`;
/// 0 in lanes without an event. False where the ray of an event leads away from the view.
template <int kSupport, int kUnknowns>
[[nodiscard]] bool event_rows(const EventLanes<kSupport>& events, const EdgeState<kUnknowns>& edge,
                              const PinholeCamera& camera, const std::array<DoubleLanes, 6>& motion,
                              RowLanes<kUnknowns>& rows);
/// The residuals alone.
template <int kSupport, int kUnknowns>
[[nodiscard]] bool event_residuals(const EventLanes<kSupport>& events,
                                   const EdgeState<kUnknowns>& edge, const PinholeCamera& camera,
                                   const std::array<DoubleLanes, 6>& motion,
                                   DoubleLanes& residuals);

/// The twists at the events' times, of a path's unknowns, six each.
template <int kSupport>
[[nodiscard]] std::array<DoubleLanes, 6> motion_of(const EventLanes<kSupport>& events,
                                                   std::span<const double> path);

}  // namespace saccade
