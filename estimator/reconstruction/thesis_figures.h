#pragma once

#include <filesystem>

#include "core/io/dataset/dataset.h"
#include "estimator/reconstruction/image_solver.h"

namespace saccade {

/// Writes the thesis's figures of two parts of the method, computed from the truth, into
/// `folder`/figures:
///   poisson.exr (fig. 6.1), if the dataset has frames: log intensity `L` of the grey frame nearest to
///     the view, of mean 0; its gradient `gx`, `gy` and divergence `div`; the solutions of Poisson's
///     equation for that, of mean 0: `dirichlet`, `neumann`.
///   propagation.exr (fig. 6.2): the depth of the view [m], 0 = unknown, propagated to a view 0.2 s
///     away within the window: `Z` as a surface, `k01`, `k03` ... as Gaussians of 1 x 1, 3 x 3 ...
///     pixels; time and pose in views.yaml.
void write_thesis_figures(const std::filesystem::path& folder, const Dataset& dataset,
                          const ReconstructionWindow& window);

}  // namespace saccade
