#include "eval/picture/view/stabilized_view.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/io/images/image_file.h"
#include "core/srgb.h"
#include "eval/picture/canvas/canvas.h"
#include "eval/picture/image/event_picture.h"
#include "eval/picture/image/log_picture.h"
#include "eval/picture/write_video.h"

namespace saccade {
namespace {

constexpr float kBrightQuantile = 0.99F;  // of the counts

std::filesystem::path folder_of(const RunFolder& run) { return run.folder / "stabilized"; }

void add_event(ImageF& counts, const Eigen::Vector2f& pixel) {
  if (is_inside(counts, pixel.x(), pixel.y())) splat(counts, pixel.x(), pixel.y(), 1.0F);
}

}  // namespace

ImageRgb8 draw_counts(const ImageF& counts, float max) {
  ImageF shown = counts;
  for (float& value : shown.pixels()) value = std::log1p(value);
  return draw_magnitude(shown, {}, std::log1p(max));
}

ImageRgb8 draw_frame(const ImageF& radiance) {
  const ImageU8 codes = srgb8_from_linear(radiance);
  ImageRgb8 picture(codes.width(), codes.height());
  for (std::size_t i = 0; i < codes.size(); ++i) picture.pixels()[i].fill(codes.pixels()[i]);
  return picture;
}

bool StabilizedView::is_in(const RunFolder& run) {
  return std::filesystem::exists(folder_of(run) / "events.h5") ||
         std::filesystem::exists(folder_of(run) / "images.txt");
}

StabilizedView::StabilizedView(const RunFolder& run, const Dataset& dataset, std::size_t events,
                               int upscale)
    : dataset_(dataset),
      undistortion_(dataset.camera()),
      count_(events > 0 ? events
                        : static_cast<std::size_t>(dataset.camera().width) *
                              static_cast<std::size_t>(dataset.camera().height)),
      upscale_(upscale) {
  if (std::filesystem::exists(folder_of(run) / "events.h5")) run_ = load_stabilized(folder_of(run));
  if (std::filesystem::exists(folder_of(run) / "images.txt"))
    files_ = read_file_list(folder_of(run) / "images.txt");
}

std::vector<CaptionedPicture> StabilizedView::events(double t_s) const {
  if (run_.events.empty()) return {};
  const std::span<const Event> around = events_around(run_.events, t_s, count_);
  const auto first = static_cast<std::size_t>(around.data() - run_.events.data());
  ImageF before(dataset_.camera().width, dataset_.camera().height);
  ImageF after = before;
  for (std::size_t i = first; i < first + around.size(); ++i) {
    add_event(before, undistortion_(run_.coordinates.source_x[i], run_.coordinates.source_y[i]));
    add_event(after, {run_.coordinates.x[i], run_.coordinates.y[i]});
  }
  const float max = std::max(quantile(after, {}, kBrightQuantile), 1.0F);
  const double length_ms =
      around.empty() ? 0 : 1e3 * seconds_from_ns(around.back().t_ns - around.front().t_ns);
  return {{fmt::format("events of {:.1f} ms", length_ms),
           saccade::upscale(draw_counts(before, max), upscale_)},
          {"stabilized", saccade::upscale(draw_counts(after, max), upscale_)}};
}

std::vector<CaptionedPicture> StabilizedView::frames(double t_s) const {
  if (files_.empty()) return {};
  const StampedFile& file = files_[current_file(files_, t_s)];
  // Times in the two lists may differ by rounding.
  const std::optional<std::size_t> original = nearest_file(dataset_.frames(), file.t_s);
  std::vector<CaptionedPicture> pictures;
  if (original)
    pictures.push_back({fmt::format("frame of {:.3f} s", file.t_s),
                        saccade::upscale(draw_frame(dataset_.load_frame(*original)), upscale_)});
  pictures.push_back({"stabilized", saccade::upscale(read_image_rgb(file.file), upscale_)});
  return pictures;
}

void render_stabilized(const RunFolder& run, const Dataset& dataset, const std::string& title,
                       const RunRecord::Window& span, const std::filesystem::path& output,
                       const RenderOptions& options) {
  constexpr double kTimes[] = {0.15, 0.5, 0.85};
  const StabilizedView view(run, dataset, options.events.value_or(0), options.upscale);
  const Theme& theme = options.dark ? kDarkTheme : kLightTheme;
  const auto add_time = [&](ContactSheet& sheet, double t_s) {
    if (auto frames = view.frames(t_s); !frames.empty())
      sheet.add_row(fmt::format("{:.3f} s", t_s), std::move(frames));
    if (auto events = view.events(t_s); !events.empty())
      sheet.add_row(fmt::format("{:.3f} s", t_s), std::move(events));
  };
  if (output.extension() == ".mp4") {
    return write_slow_motion_video(output, span, options, [&](double t_s) {
      ContactSheet sheet(title, theme);
      add_time(sheet, t_s);
      return sheet.draw();
    });
  }
  ContactSheet sheet(title, theme);
  if (options.time_s) {
    add_time(sheet, *options.time_s);
  } else {
    for (const double fraction : kTimes)
      add_time(sheet, span.start_s + fraction * (span.end_s - span.start_s));
  }
  write_png(output, sheet.draw());
}

}  // namespace saccade
