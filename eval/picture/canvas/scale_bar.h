#pragma once

#include "eval/picture/canvas/canvas.h"
#include "eval/picture/canvas/colour.h"

namespace saccade {

/// Draws a scale bar of 1, 2 or 5 times a power of ten metres, the longest within a third of the
/// width, into the lower left corner. `px_per_m` > 0.
void draw_scale_bar(Canvas& canvas, double px_per_m, const Theme& theme);

}  // namespace saccade
