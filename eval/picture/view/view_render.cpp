#include "eval/picture/view/view_render.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "core/error.h"
#include "core/io/images/image_file.h"
#include "eval/picture/canvas/canvas.h"
#include "eval/picture/write_video.h"
#include "eval/table/number_text.h"

namespace saccade {
namespace {

constexpr std::size_t kMaxRows = 6;
/// Slow: each frame shows another view or another state of the reconstruction.
constexpr double kViewFps = 3;
/// Tolerance for rounded times at the ends of a window.
constexpr double kRoundingS = 1e-6;

std::vector<std::size_t> shown_views(const ViewPictures& views, const RunRecord::Window& span,
                                     const std::optional<double>& time_s) {
  const std::vector<double>& times = views.times();
  if (time_s) {
    const auto nearest = std::min_element(times.begin(), times.end(), [&](double a, double b) {
      return std::abs(a - *time_s) < std::abs(b - *time_s);
    });
    return {static_cast<std::size_t>(nearest - times.begin())};
  }
  std::vector<std::size_t> shown;
  for (std::size_t i = 0; i < times.size(); ++i)
    if (times[i] >= span.start_s - kRoundingS && times[i] <= span.end_s + kRoundingS)
      shown.push_back(i);
  if (shown.empty())
    throw InputError(fmt::format("{:.3f} .. {:.3f} s", span.start_s, span.end_s),
                     "holds no view of the run");
  return shown;
}

/// Pictures side by side, each with its caption below.
ImageRgb8 captioned_below(const std::vector<CaptionedPicture>& pictures, const Theme& theme) {
  constexpr int kMargin = 16;
  constexpr int kCaptionHeight = 28;
  const ImageRgb8& first = pictures.front().image;
  const int spacing = first.width() + kMargin;
  Canvas canvas(static_cast<int>(pictures.size()) * spacing + kMargin,
                first.height() + kMargin + kCaptionHeight, theme.background);
  int x = kMargin;
  for (const CaptionedPicture& picture : pictures) {
    canvas.paste(picture.image, x, kMargin);
    canvas.text(picture.caption, Eigen::Vector2d(x, kMargin + first.height() + 19), theme.text);
    x += spacing;
  }
  return canvas.image();
}

}  // namespace

void write_growth_video(const std::vector<GrowthStep>& steps,
                        const std::optional<CaptionedPicture>& truth,
                        const std::filesystem::path& output, const RenderOptions& options) {
  const Theme& theme = options.dark ? kDarkTheme : kLightTheme;
  const int factor = truth ? options.upscale : 1;
  write_video(
      output, steps.size(), options.fps.value_or(kViewFps), options.crf, [&](std::size_t i) {
        std::vector<CaptionedPicture> pictures = {
            {grouped(steps[i].events) + " events", upscale(read_image_rgb(steps[i].file), factor)}};
        if (truth) pictures.push_back(*truth);
        return captioned_below(pictures, theme);
      });
}

void render_views(const RunFolder& run, const Dataset& dataset, const ViewPictures& views,
                  const std::string& title, const RunRecord::Window& span,
                  const std::filesystem::path& output, const RenderOptions& options) {
  const bool is_video = output.extension() == ".mp4";
  const double fps = options.fps.value_or(kViewFps);
  if (is_video)
    if (const auto steps = growth_steps(run.folder); !steps.empty()) {
      const auto whole =
          image_pictures(load_image_views(run.folder).at(0), dataset, options.upscale);
      const auto truth = whole.size() > 1 ? std::optional(whole[1]) : std::nullopt;
      return write_growth_video(steps, truth, output, options);
    }
  const Theme& theme = options.dark ? kDarkTheme : kLightTheme;
  const std::vector<std::size_t> shown =
      shown_views(views, span, is_video ? std::nullopt : options.time_s);
  const auto add_row = [&](ContactSheet& sheet, std::size_t view) {
    sheet.add_row(fmt::format("{:.3f} s", views.times()[view]),
                  views.pictures(view, options.events.value_or(0), options.upscale, theme));
  };
  if (is_video)
    return write_video(output, shown.size(), fps, options.crf, [&](std::size_t i) {
      ContactSheet sheet(title, theme);
      add_row(sheet, shown[i]);
      return sheet.draw();
    });
  ContactSheet sheet(title, theme);
  for (const std::size_t i : evenly_spaced_indices(shown.size(), kMaxRows))
    add_row(sheet, shown[i]);
  write_png(output, sheet.draw());
}

}  // namespace saccade
