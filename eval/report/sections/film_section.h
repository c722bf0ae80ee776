#pragma once

#include <string>

#include "eval/report/run_data.h"

namespace saccade {

/// A short film of the run as `saccade render` makes it, small and inside the page, which a reader
/// starts; its middle stands there until then and on paper. Empty for a run that came to nothing,
/// whose dataset is gone, or with too little for a film. Throws InputError as render() does,
/// without ffmpeg above all.
[[nodiscard]] std::string film_section(const RunData& data);

}  // namespace saccade
