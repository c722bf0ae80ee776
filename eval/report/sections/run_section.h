#pragma once

#include <string>

#include "eval/report/run_data.h"

namespace saccade {

/// Everything about one run below its heading, as HTML: key numbers, 3-D view, plots, pictures,
/// alignments, stages, provenance, the commands that repeat it. The views are filled by the page's
/// script from run_page_data(), which stands beside them. `film`: with film_section().
[[nodiscard]] std::string run_section(const RunData& data, bool film);

/// Pictures of a dataset: events, frame and depth at its middle. Empty without events.
[[nodiscard]] std::string dataset_pictures(const RunData& data);

}  // namespace saccade
