#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <span>
#include <vector>

#include "core/config/fields.h"
#include "core/event.h"
#include "core/image.h"
#include "core/io/run/view_list.h"
#include "estimator/reconstruction/image_solver.h"

namespace saccade {

/// An image from the first `events` events.
struct Snapshot {
  std::size_t events = 0;
  ImageF log_image;
};

/// Describes the key `snapshot_events` of a configuration.
void describe_snapshots(config::Fields& fields, std::vector<std::int64_t>& counts);

/// The images from the first `counts[i]` > 0 of some events, as in thesis figs. 8.14 and 8.15. In
/// parallel.
[[nodiscard]] std::vector<Snapshot> take_snapshots(
    std::span<const Event> events, const std::vector<std::int64_t>& counts,
    const std::function<ImageF(std::span<const Event>)>& log_image_of);

/// growth/growth_%09d.png by number of events; nothing without snapshots.
void write_snapshots(const std::filesystem::path& folder, std::span<const Snapshot> snapshots);

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
