#include "eval/picture/view/mosaic_picture.h"

#include <fmt/format.h>

#include <cmath>

#include "core/error.h"
#include "core/io/images/image_file.h"
#include "eval/picture/image/log_picture.h"
#include "eval/picture/view/view_pictures.h"
#include "eval/picture/view/view_render.h"

namespace saccade {

std::vector<CaptionedPicture> mosaic_pictures(const MosaicView& view, const RunFolder& run,
                                              const Dataset& dataset) {
  auto comparison = compare_mosaic(view, run, dataset);
  if (comparison) comparison->image.truth = comparison->mean_truth;
  const auto scores = comparison ? score_image(comparison->image) : std::nullopt;
  const ImageF& shown = scores ? scores->fitted : view.log_image;
  const ImageF& scale = scores ? comparison->image.truth : view.log_image;
  const float low = quantile(scale, view.observed, 0.005);
  const float high = quantile(scale, view.observed, 0.995);
  std::vector<CaptionedPicture> pictures = {
      {"mosaic (unobserved: blue)", draw_log_image(shown, view.observed, low, high)}};
  if (!scores) return pictures;
  ImageF error = scores->fitted;
  for (std::size_t i = 0; i < error.size(); ++i)
    error.pixels()[i] = std::abs(error.pixels()[i] - scale.pixels()[i]);
  pictures.push_back({"true log intensity (never in view: blue)",
                      draw_log_image(scale, comparison->swept, low, high)});
  pictures.push_back({fmt::format("error, 0 to {:g} log units", kMaxLogError),
                      draw_magnitude(error, comparison->image.mask, kMaxLogError)});
  return pictures;
}

void render_mosaic(const RunFolder& run, const Dataset& dataset, const MosaicView& view,
                   const std::string& title, const std::filesystem::path& output,
                   const RenderOptions& options) {
  if (output.extension() == ".mp4") {
    const std::vector<GrowthStep> steps = growth_steps(run.folder);
    if (steps.empty())
      throw InputError(run.folder.string(),
                       "keeps no growth pictures to make a video of; run with --set growth=[...]");
    return write_growth_video(steps, std::nullopt, output, options);
  }
  ContactSheet sheet(title, options.dark ? kDarkTheme : kLightTheme);
  for (const CaptionedPicture& picture : mosaic_pictures(view, run, dataset))
    sheet.add_row("", {picture});
  write_png(output, sheet.draw());
}

}  // namespace saccade
