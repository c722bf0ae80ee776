#pragma once

#include <filesystem>
#include <vector>

#include "core/io/dataset/dataset.h"
#include "eval/picture/canvas/colour.h"
#include "eval/picture/canvas/contact_sheet.h"

namespace saccade {

/// The stages of the Poisson reconstruction from true gradients (thesis fig. 6.1): frame, gradient,
/// its divergence, the solutions with both boundary conditions and their residuals, from
/// figures/poisson.exr in a run folder. Empty without it. `upscale` screen pixels per sensor pixel.
[[nodiscard]] std::vector<CaptionedPicture> poisson_pictures(const std::filesystem::path& run,
                                                             int upscale);

/// The depth of one view propagated to another with kernels of several sizes and as a surface, and
/// the truth (fig. 6.2), from figures/propagation.exr. Empty without it.
[[nodiscard]] std::vector<CaptionedPicture> propagation_pictures(const std::filesystem::path& run,
                                                                 const Dataset& dataset,
                                                                 int upscale, const Theme& theme);

}  // namespace saccade
