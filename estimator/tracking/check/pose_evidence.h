#pragma once

namespace saccade {

/// What a measurement tells of a pose: whether it lies where the map's edges project. Of an events'
/// image these are the newest events, of a grey frame its steep pixels. All zero where no map is in
/// view.
struct PoseEvidence {
  double explained = 0;  ///< fraction of the measurement, within the map, that lies on its edges
  double chance = 0;     ///< of anywhere within the map: fraction of its area that its edges cover
  double in_map = 0;     ///< fraction of the measurement that lies within the map
  double edges_confirmed = 0;     ///< fraction of the map's edges at which something was measured
  double confirmed_if_wrong = 0;  ///< the largest such fraction of the poses at the limit of a loss
  double depth_m = 0;             ///< harmonic mean of the edges in view
  int measured = 0;               ///< events or pixels within the map
  int edges = 0;                  ///< points of the map in view
  bool tracker_lost = false;      ///< what the tracker itself says

  [[nodiscard]] bool operator==(const PoseEvidence&) const = default;
};

/// Limits of a pose that is not lost (docs/metrics.md): of the position, relative to the depth, ...
inline constexpr double kLossDepthRatio = 0.05;
/// ... and of the rotation [rad]: 5 degrees.
inline constexpr double kLossAngle_rad = 0.0872664625997165;

}  // namespace saccade
