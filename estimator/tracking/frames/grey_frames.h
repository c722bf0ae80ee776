#pragma once

#include <vector>

#include "core/image.h"
#include "core/io/dataset/dataset.h"
#include "core/srgb.h"
#include "estimator/tracking/tracker.h"

namespace saccade {

/// Log intensity of 8-bit codes; black and white (0, 255) are outside of the camera's range:
/// kUnknownLogIntensity.
[[nodiscard]] ImageF log_intensity_of_codes(const ImageU8& codes, const ToneCurve& tone,
                                            double log_eps);

/// The 8-bit pictures (not the radiance beside them) with start_s <= t <= end_s, taken by `camera`,
/// decoded by the tone curve that dataset.yaml states, else sRGB. Throws InputError naming the
/// dataset where there is none in the window, or the file that is no 8-bit picture of the camera's
/// size.
[[nodiscard]] std::vector<GreyFrame> load_grey_frames(const Dataset& dataset,
                                                      const PinholeCamera& camera, double start_s,
                                                      double end_s);

}  // namespace saccade
