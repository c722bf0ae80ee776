#pragma once

#include <filesystem>
#include <optional>
#include <vector>

#include "core/image.h"
#include "core/io/dataset/dataset.h"
#include "eval/metrics/image_metrics.h"
#include "eval/metrics/metrics.h"

namespace saccade {

/// An image that an estimate claims of one view.
struct ImageView {
  double t_s = 0;
  ImageF log_image;                                    ///< undistorted
  ImageU8 observed;                                    ///< empty: everything
  ImageF gradient_x, gradient_y;                       ///< empty: not stated
  ImageF covariance_xx, covariance_xy, covariance_yy;  ///< of the gradient; empty: not stated
};

/// An EXR with channels L (or the only one) and, perhaps, observed.
[[nodiscard]] ImageView read_log_image(const std::filesystem::path& file, double t_s);

/// The views of views.yaml in `folder` that have an image. Empty without views.yaml.
[[nodiscard]] std::vector<ImageView> load_image_views(const std::filesystem::path& folder);

/// One view from any program's image at `t_s`: EXR (L or the only channel: log intensity; observed
/// where there is one), or an 8-bit picture, taken for sRGB codes of the intensity.
[[nodiscard]] ImageView load_image(const std::filesystem::path& file, const Dataset& dataset,
                                   double t_s);

/// The view beside ln(eps + I) of the grey frame nearest in time, undistorted: as it is where the
/// two are less than 0.1 ms apart, otherwise carried over to the view's true pose by the true
/// depth; where that is unknown (a recording), as it is too. nullopt without frames.
[[nodiscard]] std::optional<ImageComparison> compare_image(const ImageView& view,
                                                           const Dataset& dataset);

/// set_image_scores() of all views.
[[nodiscard]] Metrics score_images(const std::vector<ImageView>& views, const Dataset& dataset);

}  // namespace saccade
