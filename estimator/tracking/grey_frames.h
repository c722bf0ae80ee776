#pragma once

#include <limits>
#include <vector>

#include "core/event.h"
#include "core/image.h"
#include "core/io/dataset/dataset.h"
#include "core/srgb.h"

namespace saccade {

/// Log intensity of a pixel that shows nothing.
inline constexpr float kUnknownLevel = std::numeric_limits<float>::quiet_NaN();

/// What a frame camera delivered at one time, on the undistorted sensor.
struct GreyFrame {
  TimeNs t_ns = 0;       ///< the middle of the exposure
  ImageF log_intensity;  ///< ln(eps + I); kUnknownLevel where the pixel or the lens shows nothing
};

/// Log intensity of 8-bit codes; what is black or white (0, 255) was outside of the camera's range
/// and says nothing: kUnknownLevel.
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
