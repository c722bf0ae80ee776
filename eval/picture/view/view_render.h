#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "eval/picture/render.h"
#include "eval/picture/view/view_pictures.h"
#include "eval/run_folder.h"

namespace saccade {

/// Draws a run that wrote views, see render(). `span`: whose views are shown; with
/// `options.time_s` the one nearest to it. Throws InputError where no view is in the span.
void render_views(const RunFolder& run, const Dataset& dataset, const ViewPictures& views,
                  const std::string& title, const RunRecord::Window& span,
                  const std::filesystem::path& output, const RenderOptions& options);

/// Writes a video of growth/, beside a `truth` that has the size of its pictures times
/// `options.upscale`; without one the pictures as they are.
void write_growth_video(const std::vector<GrowthStep>& steps,
                        const std::optional<CaptionedPicture>& truth,
                        const std::filesystem::path& output, const RenderOptions& options);

}  // namespace saccade
