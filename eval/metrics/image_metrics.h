#pragma once

#include <optional>
#include <span>

#include "core/image.h"
#include "eval/metrics/metrics.h"

namespace saccade {

/// A reconstructed view beside the truth, images of one size.
struct ImageComparison {
  double t_s = 0;
  ImageF estimate;                ///< log intensity, or anything in proportion to it
  ImageF truth;                   ///< log intensity
  ImageU8 mask;                   ///< 1 where the estimate is observed and the truth is known
  double observed = 0;            ///< fraction of the image that the estimate observed
  ImageF gradient_x, gradient_y;  ///< as estimated; empty: those of `estimate` are taken
};

/// What the estimate is worth: `fitted` = scale * estimate + offset, least squares on the mask.
struct ImageScores {
  double scale = 0, offset = 0;
  double pearson = 0;           ///< correlation of log intensity
  double mse = 0;               ///< of the fitted log intensity
  double ssim = 0;              ///< of the same
  double gradient_pearson = 0;  ///< correlation of gradient magnitudes
  double observed = 0;
  ImageF fitted;
};

/// Structural similarity (Wang et al. 2004) of b with a: windows of 11 x 11 Gaussian weights, sigma
/// 1.5, k1 = 0.01, k2 = 0.03, range = max - min of `a` on the mask, > 0; moments of the weights,
/// not of a sample (divided by their sum); averaged over the pixels of the mask. Beyond the image,
/// and off the mask, windows are cut off: weights of what is left sum to one.
[[nodiscard]] double structural_similarity(const ImageF& a, const ImageF& b, const ImageU8& mask);

/// nullopt where the mask holds fewer than 100 pixels or the truth is constant on it.
[[nodiscard]] std::optional<ImageScores> score_image(const ImageComparison& comparison);

/// |grad| by central differences, one-sided at the border [1/px].
[[nodiscard]] ImageF gradient_size(const ImageF& image);

/// Sets reconstruction.{ssim,pearson,rmse_log,mse,gradient_pearson,observed,fit.scale,fit.offset}:
/// the mean over the views, and reconstruction.views.{count}, reconstruction.worst.{ssim,pearson}.
/// null where no view has a truth.
void set_image_scores(Metrics& metrics, std::span<const std::optional<ImageScores>> views);

}  // namespace saccade
