#include "eval/picture/figure/tracking_stages.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <string>
#include <utility>

#include "core/error.h"
#include "core/io/images/exr_file.h"
#include "eval/picture/canvas/canvas.h"
#include "eval/picture/image/depth_picture.h"
#include "eval/picture/image/log_picture.h"
#include "eval/table/number_text.h"

namespace saccade {
namespace {

/// The channels of figures/tracking.exr as pictures.
class Stages {
 public:
  Stages(std::filesystem::path file, int factor, const Theme& theme)
      : file_(std::move(file)), factor_(factor), theme_(theme) {
    for (ExrChannel& channel : read_exr_channels(file_))
      images_[channel.name] = std::move(channel.image);
  }

  [[nodiscard]] const ImageF& at(const std::string& name) const {
    const auto found = images_.find(name);
    if (found == images_.end())
      throw InputError(file_.string(), fmt::format("lacks the channel {}", name));
    return found->second;
  }

  /// Black to white from `low` to `high`.
  [[nodiscard]] CaptionedPicture grey(const std::string& caption, const std::string& name,
                                      float low, float high) const {
    return {caption, upscale(draw_log_image(at(name), {}, low, high), factor_)};
  }

  /// In the colours of the mask's own depths.
  [[nodiscard]] CaptionedPicture depth(const std::string& caption, const std::string& name) const {
    return {caption, draw_depth_map(at(name), depth_range(at("mask_depth")), factor_, theme_)};
  }

  /// The chosen points over the faint template.
  [[nodiscard]] CaptionedPicture selection(const std::string& what, const std::string& name) const {
    const ImageF& chosen = at(name);
    const ImageF& lit = at("template");
    ImageRgb8 image(chosen.width(), chosen.height());
    double count = 0;
    for (std::size_t i = 0; i < chosen.size(); ++i) {
      const bool is_chosen = chosen.pixels()[i] > 0;
      count += is_chosen ? 1 : 0;
      const double weight = std::min(1.0, static_cast<double>(lit.pixels()[i]));
      image.pixels()[i] = is_chosen ? theme_.on : mix(theme_.background, theme_.faint, weight);
    }
    return {fmt::format("{}: {} points", what, grouped(count)), upscale(image, factor_)};
  }

 private:
  std::filesystem::path file_;
  int factor_;
  Theme theme_;
  std::map<std::string, ImageF> images_;
};

/// The map from above, in the frame of the reference view's world turned into the camera's axes.
CaptionedPicture map_from_above(const RunFolder& run, int width, int height, const Theme& theme) {
  std::vector<Eigen::Vector3d> points;
  Rigid3 camera_from_world;
  if (run.trajectory && !run.trajectory->empty())
    camera_from_world = run.trajectory->poses().front().world_from_camera.inverse();
  for (const Eigen::Vector3f& point : run.load_map().positions)
    points.push_back(camera_from_world * point.cast<double>());
  return {"map from above", draw_top_down(points, width, height, theme)};
}

}  // namespace

std::vector<std::vector<CaptionedPicture>> tracking_stages(const RunFolder& run, int factor,
                                                           const Theme& theme) {
  const std::filesystem::path file = run.folder / "figures" / "tracking.exr";
  if (!std::filesystem::exists(file)) return {};
  const Stages stages(file, factor, theme);
  const ImageF& log_image = stages.at("L");
  const auto high_quantile = [&](const char* name) { return quantile(stages.at(name), {}, 0.99); };
  return {
      {stages.grey("log intensity", "L", quantile(log_image, {}, 0.005),
                   quantile(log_image, {}, 0.995)),
       stages.grey("magnitude of its gradient", "gradient", 0, high_quantile("gradient")),
       stages.grey("map points", "map", 0, 1),
       map_from_above(run, log_image.width() * factor, log_image.height() * factor, theme)},
      {stages.grey("map in the view", "mask", 0, 1), stages.depth("its depth", "mask_depth"),
       stages.grey("after the blur", "template", 0, 1),
       stages.depth("depth after the blur", "template_depth")},
      {stages.grey("template T", "template", 0, 1), stages.grey("event frame I", "events", 0, 1)},
      {stages.selection("dense", "dense"), stages.selection("semi-dense", "semi_dense"),
       stages.selection("sparse patches", "sparse_patches"),
       stages.selection("random, one iteration", "random")}};
}

}  // namespace saccade
