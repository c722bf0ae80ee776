#pragma once

#include <filesystem>
#include <optional>

#include <Eigen/Core>

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

/// The truth's world from the estimate's: an inertial sensor does not know the heading.
struct MosaicAlignment {
  /// Equal orientations at the beginning of the run's window.
  Eigen::Matrix3d initial = Eigen::Matrix3d::Identity();
  /// Least squares over the orientations within it.
  Eigen::Matrix3d mean = Eigen::Matrix3d::Identity();
  double residual_rad = 0;  ///< RMS of what the orientations are off after `mean`
};

/// A mosaic beside ln(eps + I) of the dataset's panorama, as the mosaic's pixels see it.
struct MosaicComparison {
  MosaicAlignment alignment;
  ImageComparison image;       ///< by the initial orientation; observed: share of the area `swept`
  ImageF mean_truth;           ///< by the mean one
  ImageU8 swept;               ///< 1 where the true camera saw the mosaic's pixel
  double span = 0;             ///< solid angle observed against the camera's field of view
  double span_horizontal = 0;  ///< angle of the columns observed against the camera's
};

/// nullopt where the dataset holds no panorama.exr or no poses within the run's window.
[[nodiscard]] std::optional<MosaicComparison> compare_mosaic(const MosaicView& view,
                                                             const RunFolder& run,
                                                             const Dataset& dataset);

/// mosaic.{ssim,pearson,rmse_log,mse,gradient_pearson,fit.scale,fit.offset} by the initial
/// orientation, mosaic.aligned.{ssim,pearson} by the mean one, mosaic.alignment.{rotation_deg (from
/// the one to the other),residual_deg}, mosaic.observed (share of the solid angle that came into
/// view), mosaic.span.{solid_angle,horizontal} (in fields of view). Scores are null without truth.
[[nodiscard]] Metrics score_mosaic(const std::optional<MosaicComparison>& comparison);

}  // namespace saccade
