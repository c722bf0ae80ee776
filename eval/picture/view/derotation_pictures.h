#pragma once

#include <vector>

#include "core/io/dataset/dataset.h"
#include "eval/picture/canvas/contact_sheet.h"

namespace saccade {

/// The events around `t_s`, one per pixel, as they came and rotated into the camera's orientation
/// then by the true poses (thesis fig. 5.2). Empty where the dataset has no ground truth or no
/// events around it.
[[nodiscard]] std::vector<CaptionedPicture> derotation_pictures(const Dataset& dataset, double t_s,
                                                                int upscale);

}  // namespace saccade
