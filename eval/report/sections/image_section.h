#pragma once

#include <filesystem>
#include <string>

#include "eval/report/run_data.h"

namespace saccade {

/// The images of a run as HTML: scores of every view; truth, reconstruction, error and standard deviation of
/// the gradient of one view, what is unobserved in colour; the image growing with the events
/// (thesis figs. 8.14 and 8.15). Empty where the run has none or its dataset is gone.
[[nodiscard]] std::string image_section(const RunData& data);

/// The pictures of growth/ as HTML, `upscale` screen pixels per pixel; empty where there are none,
/// or so many that they are a film's.
[[nodiscard]] std::string growth_pictures(const std::filesystem::path& folder, int upscale);

}  // namespace saccade
