#include "eval/report/sections/module_sections.h"

#include <fmt/format.h>

#include <cmath>
#include <cstddef>
#include <filesystem>
#include <optional>
#include <vector>

#include "core/io/images/image_file.h"
#include "eval/image_views.h"
#include "eval/picture/canvas/canvas.h"
#include "eval/picture/image/log_picture.h"
#include "eval/picture/view/view_pictures.h"
#include "eval/report/html.h"
#include "eval/table/number_text.h"
#include "eval/table/table.h"

namespace saccade {
namespace {

std::vector<Table::Cell> scores_row(double t_s, const std::optional<ImageScores>& s) {
  std::vector<Table::Cell> row{number_cell(t_s, fixed(t_s, 3))};
  const auto add = [&](double ImageScores::*member, double scale, int decimals) {
    const auto value = s ? std::optional(scale * ((*s).*member)) : std::nullopt;
    row.push_back(number_cell(value, fixed(value, decimals)));
  };
  add(&ImageScores::ssim, 1, 3);
  add(&ImageScores::pearson, 1, 3);
  add(&ImageScores::mse, 1, 4);
  add(&ImageScores::gradient_pearson, 1, 3);
  add(&ImageScores::observed, 100, 1);
  add(&ImageScores::scale, 1, 3);
  return row;
}

/// Standard deviation of the gradient in its least sure direction.
ImageF gradient_sigma(const ImageView& view) {
  ImageF sigma = view.covariance_xx;
  for (std::size_t i = 0; i < sigma.size(); ++i) {
    const float xx = view.covariance_xx.pixels()[i];
    const float yy = view.covariance_yy.pixels()[i];
    const float xy = view.covariance_xy.pixels()[i];
    sigma.pixels()[i] = std::sqrt((xx + yy) / 2 + std::hypot((xx - yy) / 2, xy));
  }
  return sigma;
}

std::string view_pictures(const ImageView& view, const Dataset& dataset, const ImageComparison& c) {
  const std::string at = fmt::format("{:.3f} s: ", view.t_s);
  std::string html = "<div class=\"grid three\">";
  for (const CaptionedPicture& drawn : image_pictures(view, dataset, kUpscale))
    html += figure(drawn.image, at + drawn.caption, drawn.caption);
  if (!view.gradient_x.empty()) {
    ImageF magnitude = view.gradient_x;
    for (std::size_t i = 0; i < magnitude.size(); ++i)
      magnitude.pixels()[i] = std::hypot(view.gradient_x.pixels()[i], view.gradient_y.pixels()[i]);
    const ImageF truth = gradient_size(c.truth);
    const float top = quantile(truth, c.mask, 0.99);
    html += upscaled_figure(draw_magnitude(truth, {}, top), at + "size of the gradient, truth",
                            "true gradient magnitude") +
            upscaled_figure(draw_magnitude(magnitude, {}, quantile(magnitude, c.mask, 0.99)),
                            at + "size of the gradient, reconstructed", "gradient magnitude");
  }
  if (!view.covariance_xx.empty()) {
    const ImageF sigma = gradient_sigma(view);
    const float top = quantile(sigma, {}, 0.99);
    html += upscaled_figure(
        draw_magnitude(sigma, {}, top),
        at + fmt::format("standard deviation of the gradient where it is largest, 0 to {:.2g} "
                         "per px",
                         top),
        "standard deviation of the gradient");
  }
  return html + "</div>\n";
}

}  // namespace

std::string growth_pictures(const std::filesystem::path& folder, int factor) {
  const std::vector<GrowthStep> steps = growth_steps(folder);
  // A film's worth of pictures is for `saccade render`.
  constexpr std::size_t kMost = 8;
  if (steps.empty() || steps.size() > kMost) return "";
  std::string html = "<h4>Growing with the events</h4><div class=\"grid three\">";
  for (const GrowthStep& step : steps)
    html += figure(upscale(read_image_rgb(step.file), factor), grouped(step.events) + " events",
                   "reconstruction");
  return html + "</div>\n";
}

std::string image_section(const RunData& data) {
  if (!data.data) return "";
  const std::vector<ImageView> views = load_image_views(data.run.folder);
  if (views.empty()) return "";
  Table table{data.id + "_images", "Images, view by view"};
  table.add_numeric({"view [s]", "SSIM", "Pearson", "MSE", "Pearson of |gradient|", "observed [%]",
                     "scale of the fit"});
  std::optional<std::size_t> worst;
  std::vector<std::optional<ImageComparison>> comparisons;
  std::vector<std::optional<ImageScores>> scores;
  for (const ImageView& view : views) {
    comparisons.push_back(compare_image(view, *data.data));
    scores.push_back(comparisons.back() ? score_image(*comparisons.back()) : std::nullopt);
    table.rows.push_back(scores_row(view.t_s, scores.back()));
    const std::size_t i = scores.size() - 1;
    if (scores[i] && (!worst || scores[i]->ssim < scores[*worst]->ssim)) worst = i;
  }
  std::string html = table_html(table);
  if (worst) html += view_pictures(views[*worst], *data.data, *comparisons[*worst]);
  return html + growth_pictures(data.run.folder, kUpscale);
}

}  // namespace saccade
