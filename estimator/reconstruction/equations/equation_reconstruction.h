#pragma once

#include <optional>

#include "core/config/fields.h"
#include "estimator/reconstruction/image_solver.h"

namespace saccade {

struct EquationOptions {
  enum class Preset { kBest, kFast };  ///< kFast also sets options without a configuration key

  Preset preset = Preset::kBest;
  /// Thresholds of real pixels drift, so that an offset is trusted for a few events; that costs ideal
  /// data next to nothing (docs/reconstruction.md).
  ObservationOptions observations{
      .event_sigma = 0.075,
      .run_events = 12,
      .no_event_spacing_px = 0.85,
      .no_event_stride = 4,
      .dense_events_per_px = 40,
      .expected_fraction = 0.4,
      .first_event_sigma = 0.8,
      .blind_time_us = {},
      .remove_bias = true,
      .reprojection = {
          .redraw_motion_px = 8, .redraw_parallax_px = 1.4, .discontinuity_margin_px = 1}};
  double merge_radius_px = 0.9;  ///< observations of a run that lie closer are merged
  /// Of the difference of neighbours, where that is small [log units].
  double smoothness_sigma = 0.05;
  /// The sigma of the first round is so many times as large: its squares of differences flatten steep edges, and what they
  /// flatten, the absolute differences of the second do not bring back.
  double first_smoothness = 4;
  double bound_sigma = 0.3;  ///< of no-event constraints, from the second round on [log units]
  double tolerance = 0.01;   ///< of the relative residual of conjugate gradients
};

void describe(config::Fields& fields, EquationOptions& options);

/// Every event is one linear equation of the reference view's log intensity: at the instant of its
/// k-th event a pixel observes it exactly, but for an offset of its own,
///   L(reprojection at t_k) = c_pixel + sum_(i <= k) p_i C,
/// the left side bilinear between pixels. With no-event constraints and total variation as a prior
/// they are a sparse linear least-squares problem for image and offsets, solved with iteratively
/// reweighted least squares; no gradient is linearised and none integrated.
class EquationReconstruction : public ImageSolver {
 public:
  explicit EquationReconstruction(const EquationOptions& options) : options_(options) {}
  [[nodiscard]] Reconstruction solve(ObservationSource& source, std::span<const Event> events,
                                     const Trajectory& world_from_camera, const ReferenceGrid& grid,
                                     const ProgressCallback& progress) const override;

 private:
  EquationOptions options_;
};

}  // namespace saccade
