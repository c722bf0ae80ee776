#pragma once

#include <filesystem>
#include <string>

#include "apps/common_options.h"

namespace saccade {

/// Draws what the simulation of a configuration would see into a PNG file, and prints a line per
/// view: time, depths, image motion and events per second. Throws InputError for another ending.
void render_preview(const std::string& config_file, const std::filesystem::path& output, bool light,
                    const CommonOptions& common);

}  // namespace saccade
