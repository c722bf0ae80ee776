#pragma once

#include <filesystem>

#include "core/io/dataset/dataset.h"
#include "estimator/reconstruction/image_estimator.h"

namespace saccade {

/// Two steps of the method by themselves, on what is known, into `folder`/figures:
///   poisson.exr (thesis fig. 6.1), where the dataset has frames: `L` of the grey frame nearest to
///     the view, of mean 0; its gradient `gx`, `gy` and `div`; what Poisson's equation makes of
///     that, of mean 0: `dirichlet`, `neumann`.
///   propagation.exr (fig. 6.2): the depth of the view [m], 0 = unknown, as it is seen 0.2 s
///     away, within the window: `Z` as a surface, `k01`, `k03` ... as Gaussians of 1 x 1, 3 x 3
///     ... pixels; time and pose in views.yaml.
void write_step_figures(const std::filesystem::path& folder, const Dataset& dataset,
                        const ReconstructionWindow& window);

}  // namespace saccade
