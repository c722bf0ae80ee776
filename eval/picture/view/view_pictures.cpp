#include "eval/picture/view/view_pictures.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>

#include "core/error.h"
#include "eval/metrics/depth_truth.h"
#include "eval/picture/canvas/canvas.h"
#include "eval/picture/image/depth_picture.h"
#include "eval/picture/image/log_picture.h"
#include "eval/picture/view/sensor_view.h"

namespace saccade {
namespace {

/// The largest relative error of the colour scale, as in thesis figs. 8.9 and 8.10.
double max_depth_error(const Dataset& dataset) {
  return dataset.facts().name == "dunes" ? 0.045 : 0.07;
}

constexpr const char* kImageCaption = "image (unobserved: blue)";

GrowthStep growth_step(const std::filesystem::path& file) {
  const std::string stem = file.stem().string();
  const std::string digits = stem.substr(stem.find_last_of('_') + 1);
  std::size_t events = 0;
  const char* const end = digits.data() + digits.size();
  const auto parsed = std::from_chars(digits.data(), end, events);
  if (parsed.ec != std::errc{} || parsed.ptr != end)
    throw InputError(file.string(), "must be named growth_<number of events>.png");
  return {file, static_cast<double>(events)};
}

}  // namespace

std::vector<CaptionedPicture> depth_pictures(const EstimatedView& view, const Dataset& dataset,
                                             int upscale, const Theme& theme) {
  const auto truth = depth_truth_at(dataset, view.t_s);
  const PinholeCamera camera = dataset.camera().undistorted();
  const DepthRange range = truth ? depth_range(truth->depth) : depth_range(view.points);
  std::vector<CaptionedPicture> pictures = {
      {"estimated depth", draw_depth_points(view.points, camera, range, upscale, theme)}};
  if (!truth) return pictures;
  pictures.push_back({"true depth", draw_depth_map(truth->depth, range, upscale, theme)});
  pictures.push_back({"relative error of the depth",
                      draw_depth_errors(compare_depth(view.points, *truth, view.t_s), camera,
                                        max_depth_error(dataset), upscale, theme)});
  return pictures;
}

std::vector<CaptionedPicture> image_pictures(const ImageView& view, const Dataset& dataset,
                                             int factor) {
  const auto comparison = compare_image(view, dataset);
  const auto scores = comparison ? score_image(*comparison) : std::nullopt;
  if (!scores) return {{kImageCaption, draw_image_alone(view, factor)}};
  const float low = quantile(comparison->truth, comparison->mask, 0.005);
  const float high = quantile(comparison->truth, comparison->mask, 0.995);
  ImageF error = scores->fitted;
  for (std::size_t i = 0; i < error.size(); ++i)
    error.pixels()[i] = std::abs(error.pixels()[i] - comparison->truth.pixels()[i]);
  return {
      {kImageCaption, upscale(draw_log_image(scores->fitted, view.observed, low, high), factor)},
      {"log intensity, the frame's",
       upscale(draw_log_image(comparison->truth, {}, low, high), factor)},
      {fmt::format("error, 0 to {:g} log units", kMaxLogError),
       upscale(draw_magnitude(error, comparison->mask, kMaxLogError), factor)}};
}

ImageRgb8 draw_image_alone(const ImageView& view, int factor) {
  const float low = quantile(view.log_image, view.observed, 0.005);
  const float high = quantile(view.log_image, view.observed, 0.995);
  return upscale(draw_log_image(view.log_image, view.observed, low, high), factor);
}

std::vector<GrowthStep> growth_steps(const std::filesystem::path& folder) {
  std::vector<GrowthStep> steps;
  if (!std::filesystem::is_directory(folder / "growth")) return steps;
  for (const auto& entry : std::filesystem::directory_iterator(folder / "growth"))
    if (entry.path().extension() == ".png") steps.push_back(growth_step(entry.path()));
  std::sort(steps.begin(), steps.end(),
            [](const GrowthStep& a, const GrowthStep& b) { return a.events < b.events; });
  return steps;
}

ViewPictures::ViewPictures(const RunFolder& run, const Dataset& dataset)
    : dataset_(dataset), images_(load_image_views(run.folder)) {
  if (images_.empty()) depths_ = load_depth_views(run, dataset);
  for (const ImageView& view : images_) times_.push_back(view.t_s);
  for (const EstimatedView& view : depths_) times_.push_back(view.t_s);
}

std::vector<CaptionedPicture> ViewPictures::pictures(std::size_t view, std::size_t events,
                                                     int upscale, const Theme& theme) const {
  const double t_s = times_.at(view);
  const SensorView sensor(dataset_, t_s, t_s, {upscale, events, theme});
  std::vector<CaptionedPicture> row = {{"events", sensor.undistorted_events(t_s)}};
  std::vector<CaptionedPicture> found =
      images_.empty() ? depth_pictures(depths_[view], dataset_, upscale, theme)
                      : image_pictures(images_[view], dataset_, upscale);
  std::move(found.begin(), found.end(), std::back_inserter(row));
  return row;
}

std::vector<std::size_t> evenly_spaced_indices(std::size_t count, std::size_t max) {
  std::vector<std::size_t> chosen;
  const std::size_t kept = std::min(count, max);
  for (std::size_t i = 0; i < kept; ++i)
    chosen.push_back(kept == 1 ? 0 : i * (count - 1) / (kept - 1));
  return chosen;
}

}  // namespace saccade
