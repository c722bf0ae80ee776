#pragma once

#include <filesystem>
#include <span>
#include <vector>

#include "core/io/run/view_list.h"
#include "estimator/reconstruction/image_estimator.h"
#include "estimator/reconstruction/snapshots.h"

namespace saccade {

/// Log intensity as grey from the 0.5th to the 99.5th percentile of what is observed; of everything
/// where nothing is, or `observed` is empty.
[[nodiscard]] ImageU8 grey_picture(const ImageF& log_image, const ImageU8& observed);

/// EXR with channels L and observed (0 or 1).
void write_log_image(const std::filesystem::path& file, const ImageF& log_image,
                     const ImageU8& observed);

/// Writes into a run folder: gradient/gradient_%08d.exr (channels gx, gy [log units/px], their
/// covariance Pxx, Pxy, Pyy), image/image_%08d.exr (L: log intensity of mean 0; observed: 0 or 1)
/// with a PNG of its range, growth/growth_%09d.png by number of events, views.yaml.
void write_reconstruction(const std::filesystem::path& folder,
                          std::span<const ReconstructionWindow> windows,
                          std::span<const Reconstruction> results,
                          std::span<const Snapshot> snapshots);

/// The gradient and the image of one view, to the files that `view` names, whose folders exist.
void write_image_view(const Reconstruction& result, const RunView& view);

}  // namespace saccade
