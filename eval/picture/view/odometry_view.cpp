#include "eval/picture/view/odometry_view.h"

#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <iterator>
#include <utility>

#include "core/io/images/image_file.h"
#include "core/time_search.h"
#include "eval/picture/image/depth_picture.h"
#include "eval/picture/view/view_pictures.h"
#include "eval/picture/write_video.h"

namespace saccade {
namespace {

DepthRange range_of(const KeyframeHistory& history) {
  std::vector<DepthPoint> points;
  for (std::size_t i = 0; i < history.keyframes().size(); ++i) {
    const std::vector<DepthPoint>& found = history.depth(i).points;
    points.insert(points.end(), found.begin(), found.end());
  }
  return depth_range(points);
}

/// "0.21 (mean 0.18) %": the value at `t_s` and the mean until then.
std::string now_and_mean(const std::vector<double>& times_s, const std::vector<double>& values,
                         double t_s, double scale, const char* unit) {
  const std::size_t count = std::max<std::size_t>(count_until(times_s, t_s, std::identity{}), 1);
  double sum = 0;
  for (std::size_t i = 0; i < count; ++i) sum += values[i];
  return fmt::format("{:.2f} (mean {:.2f}) {}", scale * values[count - 1],
                     scale * sum / static_cast<double>(count), unit);
}

std::string error_caption(const ErrorSeries& errors, double t_s) {
  if (errors.t_s.empty()) return "trajectory from above";
  const std::string position = errors.dt_rel_percent.empty()
                                   ? now_and_mean(errors.t_s, errors.dt_m, t_s, 1e3, "mm")
                                   : now_and_mean(errors.t_s, errors.dt_rel_percent, t_s, 1, "%");
  return fmt::format("from above; error {}, {}", position,
                     now_and_mean(errors.t_s, errors.dtheta_deg, t_s, 1, "deg"));
}

/// Four pictures, two by two.
ImageRgb8 two_by_two(const OdometryView& view, const std::string& title, const Theme& theme,
                     double t_s) {
  std::vector<CaptionedPicture> upper = view.pictures(t_s);
  std::vector<CaptionedPicture> lower(std::make_move_iterator(upper.begin() + 2),
                                      std::make_move_iterator(upper.end()));
  upper.resize(2);
  ContactSheet sheet(title, theme);
  sheet.add_row(fmt::format("{:.3f} s", t_s), std::move(upper));
  sheet.add_row("", std::move(lower));
  return sheet.draw();
}

}  // namespace

OdometryView::OdometryView(const RunFolder& run, const Dataset& dataset,
                           const KeyframeHistory& history, const RunRecord::Window& loaded,
                           const SensorViewStyle& style)
    : run_(run),
      truth_from_estimate_(truth_from_estimate(score_input(run, dataset))),
      history_(history),
      sensor_(dataset, loaded.start_s, loaded.end_s, style),
      upscale_(style.upscale),
      range_(range_of(history)),
      errors_(errors_over_time(score_input(run, dataset))),
      path_(dataset.groundtruth(), truth_from_estimate_ * *run.trajectory, sensor_.width(),
            sensor_.height(), style.theme) {}

CaptionedPicture OdometryView::path(double t_s) const {
  std::vector<Eigen::Vector3d> keyframes;
  for (std::size_t i = 0; i <= history_.in_force(t_s); ++i)
    keyframes.push_back(truth_from_estimate_ *
                        history_.keyframes()[i].world_from_camera.translation());
  return {error_caption(errors_, t_s), path_.draw(t_s, keyframes)};
}

std::vector<CaptionedPicture> OdometryView::pictures(double t_s) const {
  const std::size_t keyframe = history_.in_force(t_s);
  const EstimatedView& depth = history_.depth(keyframe);
  std::vector<CaptionedPicture> pictures = {
      {"map (blue) over events",
       sensor_.map_over_events(t_s, history_.map_at(t_s), held_pose(*run_.trajectory, t_s))},
      {fmt::format("depth of keyframe {}, {:.3f} s", keyframe, depth.t_s),
       draw_depth_points(depth.points, sensor_.camera(), range_, upscale_, sensor_.theme())}};
  if (const ImageView* const image = history_.image(keyframe))
    pictures.push_back({fmt::format("image of keyframe {} (unobserved: blue)", keyframe),
                        draw_image_alone(*image, upscale_)});
  pictures.push_back(path(t_s));
  return pictures;
}

void render_odometry(const RunFolder& run, const Dataset& dataset, const KeyframeHistory& history,
                     const std::string& title, const RunRecord::Window& span,
                     const std::filesystem::path& output, const RenderOptions& options) {
  const bool is_video = output.extension() == ".mp4";
  const RunRecord::Window loaded =
      options.time_s && !is_video ? RunRecord::Window{*options.time_s, *options.time_s} : span;
  const Theme& theme = options.dark ? kDarkTheme : kLightTheme;
  const OdometryView view(run, dataset, history, loaded,
                          {options.upscale, options.events.value_or(0), theme});
  if (is_video)
    return write_slow_motion_video(output, span, options,
                                   [&](double t_s) { return two_by_two(view, title, theme, t_s); });
  if (options.time_s) return write_png(output, two_by_two(view, title, theme, *options.time_s));
  ContactSheet sheet(title, theme);
  for (const double fraction : kSheetTimes) {
    const double t_s = span.start_s + fraction * (span.end_s - span.start_s);
    sheet.add_row(fmt::format("{:.3f} s", t_s), view.pictures(t_s));
  }
  write_png(output, sheet.draw());
}

}  // namespace saccade
