#pragma once

#include <cstddef>
#include <filesystem>
#include <vector>

#include "eval/depth_views.h"
#include "eval/image_views.h"
#include "eval/picture/canvas/colour.h"
#include "eval/picture/canvas/contact_sheet.h"

namespace saccade {

/// The estimated depth of a view, the truth and the relative error; the estimate alone where the
/// truth is unknown. `upscale` screen pixels per sensor pixel.
[[nodiscard]] std::vector<CaptionedPicture> depth_pictures(const EstimatedView& view,
                                                           const Dataset& dataset, int upscale,
                                                           const Theme& theme);

/// The log intensity of a view, fitted to the truth and tinted where unobserved; the truth; the
/// error. The estimate alone, in its own range, where the truth is unknown.
[[nodiscard]] std::vector<CaptionedPicture> image_pictures(const ImageView& view,
                                                           const Dataset& dataset, int upscale);

/// The estimate alone, in its own range.
[[nodiscard]] ImageRgb8 draw_image_alone(const ImageView& view, int upscale);

/// A picture of a reconstruction from its first events.
struct GrowthStep {
  std::filesystem::path file;
  double events = 0;
};

/// The pictures growth/growth_<events>.png of a run folder, by number of events; InputError for
/// another name.
[[nodiscard]] std::vector<GrowthStep> growth_steps(const std::filesystem::path& folder);

/// Draws the views of a run of `depth` or `reconstruct`.
class ViewPictures {
 public:
  /// Reads the views of the run folder; `dataset` must outlive this.
  ViewPictures(const RunFolder& run, const Dataset& dataset);

  /// Times of the views [s]; empty for other runs.
  [[nodiscard]] const std::vector<double>& times() const { return times_; }

  /// The events around a view without distortion and what depth_pictures() or image_pictures()
  /// draw of it. `events` of them, 0: 15 % of the number of pixels.
  [[nodiscard]] std::vector<CaptionedPicture> pictures(std::size_t view, std::size_t events,
                                                       int upscale, const Theme& theme) const;

 private:
  const Dataset& dataset_;
  std::vector<ImageView> images_;
  std::vector<EstimatedView> depths_;  ///< only where there is no image
  std::vector<double> times_;
};

/// At most `max` evenly spaced indices below `count`, the first and the last included.
[[nodiscard]] std::vector<std::size_t> evenly_spaced_indices(std::size_t count, std::size_t max);

}  // namespace saccade
