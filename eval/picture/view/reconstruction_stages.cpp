#include "eval/picture/view/reconstruction_stages.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "core/error.h"
#include "core/io/images/exr_file.h"
#include "core/io/run/view_list.h"
#include "eval/metrics/depth_truth.h"
#include "eval/picture/canvas/canvas.h"
#include "eval/picture/image/depth_picture.h"
#include "eval/picture/image/log_picture.h"

namespace saccade {
namespace {

constexpr float kMaxResidual = 0.5F;   ///< [log units]
constexpr float kOutlierError = 0.1F;  ///< relative; larger errors are depths of another surface

const ImageF& channel_of(const std::vector<ExrChannel>& channels, const std::string& name,
                         const std::filesystem::path& file) {
  for (const ExrChannel& channel : channels)
    if (channel.name == name) return channel.image;
  throw InputError(file.string(), fmt::format("lacks the channel {}", name));
}

ImageF absolute_difference(const ImageF& a, const ImageF& b) {
  ImageF result = a;
  for (std::size_t i = 0; i < a.size(); ++i)
    result.pixels()[i] = std::abs(a.pixels()[i] - b.pixels()[i]);
  return result;
}

/// Zero is grey.
ImageRgb8 draw_signed(const ImageF& image) {
  const float low = quantile(image, {}, 0.01);
  const float limit = std::max({-low, quantile(image, {}, 0.99), 1e-6F});
  return draw_log_image(image, {}, -limit, limit);
}

/// The completeness of a depth map and its fraction of outliers.
std::string agreement(const ImageF& depth, const ImageF& truth) {
  double with_truth = 0, known = 0, wrong = 0;
  for (std::size_t i = 0; i < depth.size(); ++i) {
    const float z = depth.pixels()[i];
    const float expected = truth.pixels()[i];
    if (!(expected > 0) || !std::isfinite(expected)) continue;
    ++with_truth;
    if (!(z > 0)) continue;
    ++known;
    if (std::abs(z - expected) > kOutlierError * expected) ++wrong;
  }
  return fmt::format("{:.1f} % known, {:.1f} % of that with errors above {:g} %",
                     100 * known / std::max(with_truth, 1.0), 100 * wrong / std::max(known, 1.0),
                     100 * kOutlierError);
}

}  // namespace

std::vector<CaptionedPicture> poisson_pictures(const std::filesystem::path& run, int factor) {
  const std::filesystem::path file = run / "figures" / "poisson.exr";
  if (!std::filesystem::exists(file)) return {};
  const std::vector<ExrChannel> channels = read_exr_channels(file);
  const auto stage = [&](const char* name) -> const ImageF& {
    return channel_of(channels, name, file);
  };
  const ImageF& truth = stage("L");
  const float low = quantile(truth, {}, 0.005);
  const float high = quantile(truth, {}, 0.995);
  std::vector<CaptionedPicture> pictures = {
      {"log intensity of a frame", upscale(draw_log_image(truth, {}, low, high), factor)},
      {"its gradient, x", upscale(draw_signed(stage("gx")), factor)},
      {"its gradient, y", upscale(draw_signed(stage("gy")), factor)},
      {"divergence of the gradient", upscale(draw_signed(stage("div")), factor)}};
  for (const char* boundary : {"neumann", "dirichlet"}) {
    const ImageF& solved = stage(boundary);
    const ImageF residual = absolute_difference(solved, truth);
    pictures.push_back({fmt::format("recovered, {}", boundary),
                        upscale(draw_log_image(solved, {}, low, high), factor)});
    pictures.push_back(
        {fmt::format("residual, {}, 0 to {:g} (median {:.2g}, max {:.2g})", boundary, kMaxResidual,
                     quantile(residual, {}, 0.5), quantile(residual, {}, 1)),
         upscale(draw_magnitude(residual, {}, kMaxResidual), factor)});
  }
  return pictures;
}

std::vector<CaptionedPicture> propagation_pictures(const std::filesystem::path& run,
                                                   const Dataset& dataset, int upscale,
                                                   const Theme& theme) {
  const std::filesystem::path list = run / "figures" / "views.yaml";
  if (!std::filesystem::exists(list)) return {};
  std::vector<CaptionedPicture> pictures;
  for (const RunView& view : read_view_list(list)) {
    const std::vector<ExrChannel> maps = read_exr_channels(view.depth);
    const ImageF& surface = channel_of(maps, "Z", view.depth);
    const auto truth = depth_truth_at(dataset, view.t_s);
    const DepthRange range = depth_range(truth ? truth->depth : surface);
    const auto add = [&](const std::string& what, const ImageF& depth) {
      pictures.push_back({truth ? what + ": " + agreement(depth, truth->depth) : what,
                          draw_depth_map(depth, range, upscale, theme)});
    };
    for (const ExrChannel& channel : maps)
      if (channel.name.starts_with('k'))
        add(fmt::format("{0} x {0} px", std::stoi(channel.name.substr(1))), channel.image);
    add("surface", surface);
    if (truth) pictures.push_back({"truth", draw_depth_map(truth->depth, range, upscale, theme)});
  }
  return pictures;
}

}  // namespace saccade
