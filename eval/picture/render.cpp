#include "eval/picture/render.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "core/io/images/image_file.h"
#include "eval/metrics/trajectory/scored_samples.h"
#include "eval/picture/canvas/contact_sheet.h"
#include "eval/picture/figure/run_figures.h"
#include "eval/picture/image/trajectory_picture.h"
#include "eval/picture/view/mosaic_picture.h"
#include "eval/picture/view/odometry_view.h"
#include "eval/picture/view/sensor_view.h"
#include "eval/picture/view/stabilized_view.h"
#include "eval/picture/view/view_render.h"
#include "eval/picture/write_video.h"
#include "eval/run_folder.h"

namespace saccade {
namespace {

void check_options(const RenderOptions& options) {
  const auto check = [](bool holds, const char* name, const char* problem) {
    if (!holds) throw InputError(name, problem);
  };
  check(options.upscale >= 1 && options.upscale <= 8, "upscale", "must be 1..8");
  check(!options.fps || (*options.fps >= 1 && *options.fps <= 240), "fps", "must be 1..240");
  check(options.slow_motion > 0 && std::isfinite(options.slow_motion), "slow motion",
        "must be above 0");
  check(!options.events || *options.events > 0, "events", "must be above 0");
  check(!options.duration_s || *options.duration_s > 0, "duration", "must be above 0 s");
  if (!options.overlay) return;
  const std::optional<double>& width_m = options.overlay->width_m;
  check(!width_m || (*width_m > 0 && std::isfinite(*width_m)), "overlay width",
        "must be above 0 m");
}

/// A dataset, or a run with its dataset.
struct Subject {
  std::optional<RunFolder> run;
  Dataset dataset;
  std::vector<Eigen::Vector3f> map;

  [[nodiscard]] bool has_poses() const {
    return run && run->trajectory && !run->trajectory->empty();
  }
};

Subject open_subject(const std::filesystem::path& path, const RenderOptions& options) {
  if (!std::filesystem::exists(path / "run.yaml")) return {{}, Dataset::open(path), {}};
  Subject subject;
  subject.run = RunFolder::open(path);
  subject.dataset = subject.run->open_dataset(options.dataset);
  subject.map = subject.run->load_map().positions;
  return subject;
}

RunRecord::Window span_of(const Subject& subject, const RenderOptions& options) {
  RunRecord::Window span = time_span(subject.dataset);
  if (subject.run && subject.run->record.window) {
    span.start_s = std::max(span.start_s, subject.run->record.window->start_s);
    span.end_s = std::min(span.end_s, subject.run->record.window->end_s);
  }
  if (options.start_s) span.start_s = std::max(span.start_s, *options.start_s);
  if (options.duration_s) span.end_s = std::min(span.end_s, span.start_s + *options.duration_s);
  if (options.time_s && (*options.time_s < span.start_s || *options.time_s > span.end_s))
    throw InputError("time", fmt::format("{} s is not within {:.3f} .. {:.3f} s", *options.time_s,
                                         span.start_s, span.end_s));
  if (span.end_s < span.start_s)
    throw InputError(subject.dataset.folder().string(), "holds no data in that time span");
  return span;
}

std::optional<Overlay> overlay_for(const Subject& subject, const RunRecord::Window& span,
                                   const RenderOptions& options) {
  if (!options.overlay) return std::nullopt;
  return Overlay(*options.overlay, subject.dataset, subject.run ? &*subject.run : nullptr,
                 subject.map, span.start_s);
}

/// The subject with its view and overlay.
struct Scene {
  const Subject& subject;
  SensorView view;
  std::optional<Overlay> overlay;
  int upscale;
};

/// Events and frame with the overlaid picture.
std::vector<CaptionedPicture> overlaid_pictures_at(const Scene& scene, double t_s) {
  const auto over = [&](std::string caption, ImageRgb8 image, double drawn_s) {
    return scene.overlay->over({std::move(caption), std::move(image)}, drawn_s, scene.upscale,
                               scene.view.theme());
  };
  std::vector<CaptionedPicture> pictures;
  pictures.push_back(over("events", scene.view.undistorted_events(t_s), t_s));
  if (auto frame = scene.view.undistorted_frame(t_s))
    pictures.push_back(over(fmt::format("frame of {:.3f} s", frame->first),
                            std::move(frame->second), frame->first));
  return pictures;
}

/// The pictures at one time, left to right.
std::vector<CaptionedPicture> pictures_at(const Scene& scene, double t_s) {
  if (scene.overlay) return overlaid_pictures_at(scene, t_s);
  const Subject& subject = scene.subject;
  const SensorView& view = scene.view;
  std::vector<CaptionedPicture> pictures;
  if (subject.has_poses()) {
    pictures.push_back(
        {"map (blue) over events",
         view.map_over_events(t_s, subject.map, held_pose(*subject.run->trajectory, t_s))});
  } else {
    pictures.push_back({"events", view.events(t_s)});
  }
  if (auto frame = view.frame(t_s)) pictures.push_back({"frame", std::move(*frame)});
  if (subject.has_poses()) return pictures;
  if (auto depth = view.depth(t_s)) pictures.push_back({"depth", std::move(*depth)});
  return pictures;
}

std::vector<Eigen::Vector3d> positions(const Trajectory& trajectory,
                                       const RunRecord::Window& span) {
  std::vector<Eigen::Vector3d> result;
  for (const StampedPose& pose : trajectory.poses())
    if (pose.t_s >= span.start_s && pose.t_s <= span.end_s)
      result.push_back(pose.world_from_camera.translation());
  return result;
}

std::string title_of(const Subject& subject) {
  const std::string& dataset = subject.dataset.facts().name;
  if (!subject.run) return dataset;
  return fmt::format("{}: {} on {}", subject.run->name(), subject.run->record.module, dataset);
}

ImageRgb8 contact_sheet(const Scene& scene, const RunRecord::Window& span) {
  const Subject& subject = scene.subject;
  const SensorView& view = scene.view;
  ContactSheet sheet(title_of(subject), view.theme());
  for (const double fraction : kSheetTimes) {
    const double t_s = span.start_s + fraction * (span.end_s - span.start_s);
    sheet.add_row(fmt::format("{:.3f} s", t_s), pictures_at(scene, t_s));
  }
  const std::vector<Eigen::Vector3d> truth = positions(subject.dataset.groundtruth(), span);
  std::vector<Eigen::Vector3d> estimate;
  if (subject.has_poses())
    estimate = positions(
        truth_from_estimate(score_input(*subject.run, subject.dataset)) * *subject.run->trajectory,
        span);
  if (!truth.empty() || !estimate.empty())
    sheet.add_row("",
                  {{estimate.empty() ? "trajectory" : "trajectory: truth (grey), estimate (orange)",
                    draw_trajectory(truth, estimate, view.width(), view.height(), view.theme())}});
  return sheet.draw();
}

ImageRgb8 figure_of(const std::filesystem::path& path, const Subject& subject,
                    const RenderOptions& options) {
  if (!subject.run)
    throw InputError(path.string(), "is a dataset; --figure draws figures of a run");
  return draw_run_figure(
      *options.figure, title_of(subject),
      {*subject.run, subject.dataset, options.upscale, options.dark ? kDarkTheme : kLightTheme});
}

ImageRgb8 sheet_at(const Scene& scene, double t_s) {
  ContactSheet sheet(title_of(scene.subject), scene.view.theme());
  sheet.add_row(fmt::format("{:.4f} s", t_s), pictures_at(scene, t_s));
  return sheet.draw();
}

}  // namespace

void render(const std::filesystem::path& path, const std::filesystem::path& output,
            const RenderOptions& options) {
  check_options(options);
  const std::filesystem::path ending = output.extension();
  if (ending != ".png" && ending != ".mp4")
    throw InputError(output.string(), "must end in .png or .mp4");
  const Subject subject = open_subject(path, options);
  if (options.figure) {
    if (ending != ".png") throw InputError(output.string(), "must end in .png with --figure");
    return write_png(output, figure_of(path, subject, options));
  }
  const RunRecord::Window span = span_of(subject, options);
  if (subject.run && !options.overlay) {
    if (const auto mosaic = load_mosaic(*subject.run))
      return render_mosaic(*subject.run, subject.dataset, *mosaic, title_of(subject), output,
                           options);
    if (const auto history = KeyframeHistory::load(*subject.run); history && subject.has_poses())
      return render_odometry(*subject.run, subject.dataset, *history, title_of(subject), span,
                             output, options);
    const ViewPictures views(*subject.run, subject.dataset);
    if (!views.times().empty())
      return render_views(*subject.run, subject.dataset, views, title_of(subject), span, output,
                          options);
  }
  if (subject.run && !options.overlay && StabilizedView::is_in(*subject.run))
    return render_stabilized(*subject.run, subject.dataset, title_of(subject), span, output,
                             options);
  const bool single = ending == ".png" && options.time_s.has_value();
  const RunRecord::Window loaded =
      single ? RunRecord::Window{*options.time_s, *options.time_s} : span;
  // Before the events are loaded, so that errors in the overlay's options are reported at once.
  std::optional<Overlay> overlay = overlay_for(subject, span, options);
  const Scene scene{subject,
                    SensorView(subject.dataset, loaded.start_s, loaded.end_s,
                               {options.upscale, options.events.value_or(0),
                                options.dark ? kDarkTheme : kLightTheme}),
                    std::move(overlay), options.upscale};
  if (ending == ".mp4")
    return write_slow_motion_video(output, span, options,
                                   [&](double t_s) { return sheet_at(scene, t_s); });
  write_png(output, single ? sheet_at(scene, *options.time_s) : contact_sheet(scene, span));
}

}  // namespace saccade
