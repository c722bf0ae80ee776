#include "eval/picture/figure/run_figures.h"

#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <utility>

#include "core/config/suggest.h"
#include "core/error.h"
#include "core/io/images/image_file.h"
#include "eval/depth_views.h"
#include "eval/metrics/trajectory/trajectory_metrics.h"
#include "eval/picture/canvas/canvas.h"
#include "eval/picture/chart/line_chart.h"
#include "eval/picture/figure/tracking_stages.h"
#include "eval/picture/image/depth_picture.h"
#include "eval/picture/image/trajectory_picture.h"
#include "eval/picture/view/derotation_pictures.h"
#include "eval/picture/view/reconstruction_stages.h"
#include "eval/picture/view/view_pictures.h"
#include "eval/table/number_text.h"

namespace saccade {
namespace {

std::vector<LineChart::Point> curve(const std::vector<double>& t_s, const std::vector<double>& y) {
  std::vector<LineChart::Point> points;
  for (std::size_t i = 0; i < y.size(); ++i) points.push_back({t_s[i], {y[i], y[i], y[i]}});
  return points;
}

std::vector<Eigen::Vector3d> positions(const Trajectory& trajectory) {
  std::vector<Eigen::Vector3d> result;
  for (const StampedPose& pose : trajectory.poses())
    result.push_back(pose.world_from_camera.translation());
  return result;
}

/// Thesis figs. 8.4 to 8.7, 8.16 and 8.17.
FigureRows trajectory_figure(const FigureInput& input) {
  if (!input.run.trajectory || input.run.trajectory->empty()) return {};
  const TrajectoryScoreInput scores = score_input(input.run, input.dataset);
  const ErrorSeries errors = errors_over_time(scores);
  if (errors.t_s.empty()) return {};
  const bool has_depth = !errors.dt_rel_percent.empty();
  LineChart chart{.x_label = "time [s]", .names = {}, .panels = {}, .is_over_time = true};
  chart.panels.push_back({has_depth ? "position error / mean depth [%]" : "position error [m]",
                          {curve(errors.t_s, has_depth ? errors.dt_rel_percent : errors.dt_m)}});
  chart.panels.push_back({"rotation error [deg]", {curve(errors.t_s, errors.dtheta_deg)}});
  ImageRgb8 chart_image = draw(chart, input.theme);
  const std::vector<Eigen::Vector3d> truth = positions(input.dataset.groundtruth());
  std::vector<Eigen::Vector3d> estimate = positions(*input.run.trajectory);
  const Similarity aligned = truth_from_estimate(scores);
  for (Eigen::Vector3d& position : estimate) position = aligned * position;
  return {
      {{"truth (grey), estimate (orange)",
        draw_trajectory(truth, estimate, chart_image.height(), chart_image.height(), input.theme)},
       {std::string("errors ") + alignment_text(scores.freedom), std::move(chart_image)}}};
}

FigureRows tracking_figure(const FigureInput& input) {
  return tracking_stages(input.run, input.upscale, input.theme);
}

/// Fig. 5.2.
FigureRows derotation_figure(const FigureInput& input) {
  const std::vector<EstimatedView> views = load_depth_views(input.run.folder);
  if (views.empty()) return {};
  std::vector<CaptionedPicture> pictures =
      derotation_pictures(input.dataset, views.front().t_s, input.upscale);
  return pictures.empty() ? FigureRows{} : FigureRows{std::move(pictures)};
}

/// Fig. 5.3.
FigureRows keypoints_figure(const FigureInput& input) {
  const std::filesystem::path folder = input.run.folder / "keypoints";
  if (!std::filesystem::is_directory(folder)) return {};
  std::vector<std::filesystem::path> files;
  for (const auto& entry : std::filesystem::directory_iterator(folder))
    files.push_back(entry.path());
  if (files.empty()) return {};
  std::sort(files.begin(), files.end());
  return {{{"events (grey), where depth was looked for (red), where it was found (green)",
            upscale(read_image_rgb(files.front()), input.upscale)}}};
}

/// Figs. 8.9 to 8.11: the first view, and all points from above.
FigureRows cloud_figure(const FigureInput& input) {
  const std::vector<EstimatedView> views = load_depth_views(input.run, input.dataset);
  if (views.empty()) return {};
  const PinholeCamera& camera = input.dataset.camera();
  std::vector<CaptionedPicture> row =
      depth_pictures(views.front(), input.dataset, input.upscale, input.theme);
  std::vector<Eigen::Vector3d> points = points_in_world(views, camera);
  const Rigid3 camera_from_world = views[views.size() / 2].world_from_camera.inverse();
  for (Eigen::Vector3d& point : points) point = camera_from_world * point;
  row.push_back({"points of all views from above",
                 draw_top_down(points, camera.width * input.upscale, camera.height * input.upscale,
                               input.theme)});
  return {std::move(row)};
}

/// Figs. 8.14 and 8.15.
FigureRows growth_figure(const FigureInput& input) {
  std::vector<CaptionedPicture> row;
  for (const GrowthStep& step : growth_steps(input.run.folder))
    row.push_back({grouped(step.events) + " events",
                   upscale(read_image_rgb(step.file), std::max(1, input.upscale / 2))});
  return row.empty() ? FigureRows{} : FigureRows{std::move(row)};
}

/// Pictures in rows of at most `columns`.
FigureRows in_rows(std::vector<CaptionedPicture> pictures, std::size_t columns) {
  FigureRows rows;
  for (CaptionedPicture& picture : pictures) {
    if (rows.empty() || rows.back().size() == columns) rows.emplace_back();
    rows.back().push_back(std::move(picture));
  }
  return rows;
}

/// Fig. 6.1.
FigureRows poisson_figure(const FigureInput& input) {
  return in_rows(poisson_pictures(input.run.folder, input.upscale), 4);
}

/// Fig. 6.2.
FigureRows propagation_figure(const FigureInput& input) {
  return in_rows(propagation_pictures(input.run.folder, input.dataset, input.upscale, input.theme),
                 4);
}

constexpr const char* kDepthRun = "a run of depth";

constexpr RunFigure kFigures[] = {
    {.name = "trajectory",
     .help = "The path in 3-D, and the errors of position and rotation over time.",
     .needs = "estimated poses and a dataset with ground truth",
     .draw = trajectory_figure},
    {.name = "tracking",
     .help = "Map, template, event frame and selected points of one pose.",
     .needs = "a run of track with edges.figures: true",
     .draw = tracking_figure},
    {.name = "derotation",
     .help = "Events around a view as they came and turned into its orientation.",
     .needs = kDepthRun,
     .draw = derotation_figure},
    {.name = "keypoints",
     .help = "Where depth was looked for in the first view, and where it was found.",
     .needs = kDepthRun,
     .draw = keypoints_figure},
    {.name = "cloud",
     .help = "Depth of the first view with its error, and the points of all views from above.",
     .needs = kDepthRun,
     .draw = cloud_figure},
    {.name = "growth",
     .help = "The image after its first events.",
     .needs = "a run of reconstruct with snapshot_events",
     .draw = growth_figure},
    {.name = "poisson",
     .help = "Poisson's equation: true gradients in, image out.",
     .needs = "a run of reconstruct with figures: true",
     .draw = poisson_figure},
    {.name = "propagation",
     .help = "Depth of the view propagated to another by kernels of several sizes.",
     .needs = "a run of reconstruct with figures: true",
     .draw = propagation_figure},
};

const RunFigure& find_figure(std::string_view name) {
  std::vector<std::string> names;
  for (const RunFigure& figure : kFigures) {
    if (figure.name == name) return figure;
    names.emplace_back(figure.name);
  }
  throw InputError("--figure", fmt::format("'{}' is no figure of a run; {}", name,
                                           config::suggestion(name, names, "figures")));
}

}  // namespace

std::span<const RunFigure> run_figures() { return kFigures; }

ImageRgb8 draw_run_figure(std::string_view name, const std::string& title,
                          const FigureInput& input) {
  const RunFigure& figure = find_figure(name);
  FigureRows rows = figure.draw(input);
  if (rows.empty())
    throw InputError(
        input.run.folder.string(),
        fmt::format("has nothing for the figure '{}', which needs {}", name, figure.needs));
  ContactSheet sheet(title, input.theme);
  for (std::vector<CaptionedPicture>& row : rows) sheet.add_row("", std::move(row));
  return sheet.draw();
}

}  // namespace saccade
