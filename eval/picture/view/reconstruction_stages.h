#pragma once

#include <filesystem>
#include <vector>

#include "core/io/dataset.h"
#include "eval/picture/canvas/colour.h"
#include "eval/picture/canvas/contact_sheet.h"

namespace saccade {

/// From true gradients to the image by Poisson's equation (thesis fig. 6.1): frame, gradient, its
/// divergence, what either boundary gives back and the residuals, of figures/poisson.exr in a run
/// folder. Empty without it. `upscale` screen pixels per sensor pixel.
[[nodiscard]] std::vector<CaptionedPicture> poisson_pictures(const std::filesystem::path& run,
                                                             int upscale);

/// The depth of one view carried to another by kernels of several sizes and as a surface, then the
/// truth there (fig. 6.2), of figures/propagation.exr. Empty without it.
[[nodiscard]] std::vector<CaptionedPicture> propagation_pictures(const std::filesystem::path& run,
                                                                 const Dataset& dataset,
                                                                 int upscale, const Theme& theme);

}  // namespace saccade
