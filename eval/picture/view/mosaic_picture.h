#pragma once

#include <filesystem>
#include <vector>

#include "eval/mosaic_view.h"
#include "eval/picture/canvas/contact_sheet.h"
#include "eval/picture/render.h"

namespace saccade {

/// The mosaic fitted to the truth and tinted where unobserved; the truth, aligned by the mean
/// rotation and tinted where it was never in view; the error. The mosaic alone where the truth is
/// unknown.
[[nodiscard]] std::vector<CaptionedPicture> mosaic_pictures(const MosaicView& view,
                                                            const RunFolder& run,
                                                            const Dataset& dataset);

/// Draws a run that made a mosaic: .png the pictures one below the other, .mp4 the mosaic growing
/// with the events. Throws InputError for a video of a run without growth/.
void render_mosaic(const RunFolder& run, const Dataset& dataset, const MosaicView& view,
                   const std::string& title, const std::filesystem::path& output,
                   const RenderOptions& options);

}  // namespace saccade
