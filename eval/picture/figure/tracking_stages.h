#pragma once

#include <vector>

#include "eval/picture/canvas/colour.h"
#include "eval/picture/canvas/contact_sheet.h"
#include "eval/run_folder.h"

namespace saccade {

/// The stages of tracking by edges (thesis figs. 4.1 to 4.6), from figures/tracking.exr and map.ply in
/// a run folder: a row for the map, one for the template before and after its blur, one for the
/// event frame beside it, one for the selections of points. Empty without the former.
[[nodiscard]] std::vector<std::vector<CaptionedPicture>> tracking_stages(const RunFolder& run,
                                                                         int upscale,
                                                                         const Theme& theme);

}  // namespace saccade
