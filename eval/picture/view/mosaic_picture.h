#pragma once

#include <filesystem>
#include <vector>

#include "eval/mosaic_view.h"
#include "eval/picture/render.h"
#include "eval/picture/canvas/contact_sheet.h"

namespace saccade {

/// The mosaic fitted to the truth, what is unobserved tinted; the truth, by the mean orientation
/// and what did not come into view tinted; the error. The first alone where the truth is unknown.
[[nodiscard]] std::vector<CaptionedPicture> mosaic_pictures(const MosaicView& view,
                                                            const RunFolder& run,
                                                            const Dataset& dataset);

/// Draws a run that made a mosaic: .png the pictures one below the other, .mp4 the mosaic growing
/// with the events. Throws InputError for a film of a run without growth/.
void render_mosaic(const RunFolder& run, const Dataset& dataset, const MosaicView& view,
                   const std::string& title, const std::filesystem::path& output,
                   const RenderOptions& options);

}  // namespace saccade
