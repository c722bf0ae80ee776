#pragma once

#include <optional>

#include "core/image.h"
#include "core/panorama.h"
#include "core/trajectory.h"
#include "eval/metrics/image_metrics.h"
#include "eval/metrics/metrics.h"
#include "eval/run_folder.h"

namespace saccade {

/// The panorama that a run found: mosaic.exr, with mosaic.yaml and orientation.txt.
struct MosaicView {
  Panorama panorama;  ///< of the estimate's world
  ImageF log_image;
  ImageU8 observed;
  Trajectory world_from_camera;  ///< the orientations it was made with
};

/// nullopt where the run holds no mosaic.yaml. InputError where it holds the rest of it malformed.
[[nodiscard]] std::optional<MosaicView> load_mosaic(const RunFolder& run);

/// A mosaic beside ln(eps + I) of the dataset's panorama, sampled at the mosaic's pixels.
/// The truth's world is aligned with the estimate's in two ways, since an inertial sensor does not
/// know the heading.
struct MosaicComparison {
  double alignments_differ_rad = 0;  ///< angle between the two alignments
  double residual_rad = 0;           ///< RMS error of the orientations after the mean one
  /// Aligned by equal orientations at the beginning of the run's window; its `observed` is the
  /// fraction of the area `swept`.
  ImageComparison image;
  ImageF mean_truth;           ///< aligned by least squares over the orientations of the window
  ImageU8 swept;               ///< 1 where the mosaic's pixel came into the true camera's view
  double span = 0;             ///< solid angle observed against the camera's field of view
  double span_horizontal = 0;  ///< angle of the columns observed against the camera's
};

/// nullopt where the dataset holds no panorama.exr or no poses within the run's window.
[[nodiscard]] std::optional<MosaicComparison> compare_mosaic(const MosaicView& view,
                                                             const RunFolder& run,
                                                             const Dataset& dataset);

/// mosaic.{ssim,pearson,rmse_log,mse,gradient_pearson,fit.scale,fit.offset} by the initial
/// orientation, mosaic.aligned.{ssim,pearson} by the mean one, mosaic.alignment.{rotation_deg (from
/// the one to the other),residual_deg}, mosaic.observed (fraction of the solid angle that came into
/// view), mosaic.span.{solid_angle,horizontal} (in fields of view). Scores are null without truth.
[[nodiscard]] Metrics score_mosaic(const std::optional<MosaicComparison>& comparison);

}  // namespace saccade
