#include "eval/report/image_section.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <filesystem>
#include <optional>
#include <vector>

#include "core/io/image_file.h"
#include "eval/image_views.h"
#include "eval/number_text.h"
#include "eval/picture/canvas.h"
#include "eval/picture/log_picture.h"
#include "eval/report/html.h"

namespace saccade {
namespace {

constexpr int kUpscale = 2;

std::string picture(const ImageRgb8& image, const std::string& caption, const char* alt) {
  return figure(upscale(image, kUpscale), caption, alt);
}

std::string scores_row(double t_s, const std::optional<ImageScores>& s) {
  if (!s) return fmt::format("<tr><td>{:.3f}</td><td colspan=\"6\">no truth</td></tr>\n", t_s);
  return fmt::format(
      "<tr><td>{:.3f}</td><td>{:.3f}</td><td>{:.3f}</td><td>{:.4f}</td><td>{:.3f}</td>"
      "<td>{:.1f}</td><td>{:.3f}</td></tr>\n",
      t_s, s->ssim, s->pearson, s->mse, s->gradient_pearson, 100 * s->observed, s->scale);
}

/// Deviation of the gradient in its least sure direction.
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

std::string view_pictures(const ImageView& view, const ImageComparison& c, const ImageScores& s) {
  const float low = quantile(c.truth, c.mask, 0.005);
  const float high = quantile(c.truth, c.mask, 0.995);
  ImageF error = s.fitted;
  for (std::size_t i = 0; i < error.size(); ++i)
    error.pixels()[i] = std::abs(error.pixels()[i] - c.truth.pixels()[i]);
  const std::string at = fmt::format("{:.3f} s: ", view.t_s);
  std::string html = "<div class=\"grid three\">" +
                     picture(draw_log_image(c.truth, {}, low, high), at + "log intensity, truth",
                             "true log intensity") +
                     picture(draw_log_image(s.fitted, view.observed, low, high),
                             at + "reconstruction; unobserved in blue", "reconstruction") +
                     picture(draw_amount(error, c.mask, 0.5F), at + "error, 0 to 0.5 log units",
                             "error of the reconstruction");
  if (!view.gradient_x.empty()) {
    ImageF magnitude = view.gradient_x;
    for (std::size_t i = 0; i < magnitude.size(); ++i)
      magnitude.pixels()[i] = std::hypot(view.gradient_x.pixels()[i], view.gradient_y.pixels()[i]);
    const ImageF truth = gradient_size(c.truth);
    const float top = quantile(truth, c.mask, 0.99);
    html += picture(draw_amount(truth, {}, top), at + "size of the gradient, truth",
                    "true gradient magnitude") +
            picture(draw_amount(magnitude, {}, quantile(magnitude, c.mask, 0.99)),
                    at + "size of the gradient, reconstructed", "gradient magnitude");
  }
  if (!view.covariance_xx.empty()) {
    const ImageF sigma = gradient_sigma(view);
    const float top = quantile(sigma, {}, 0.99);
    html +=
        picture(draw_amount(sigma, {}, top),
                at + fmt::format("deviation of the gradient where it is least sure, 0 to {:.2g} "
                                 "per px",
                                 top),
                "deviation of the gradient");
  }
  return html + "</div>\n";
}

std::string growth_pictures(const std::filesystem::path& folder) {
  if (!std::filesystem::is_directory(folder)) return "";
  std::vector<std::filesystem::path> files;
  for (const auto& entry : std::filesystem::directory_iterator(folder))
    if (entry.path().extension() == ".png") files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  // A film's worth of pictures is for `saccade render`.
  constexpr std::size_t kMost = 8;
  if (files.empty() || files.size() > kMost) return "";
  std::string html = "<h4>Growing with the events</h4><div class=\"grid three\">";
  for (const auto& file : files) {
    const std::string stem = file.stem().string();
    const double events = std::stod(stem.substr(stem.find_last_of('_') + 1));
    html += picture(read_image_rgb(file), grouped(events) + " events", "reconstruction");
  }
  return html + "</div>\n";
}

}  // namespace

std::string image_section(const RunData& data) {
  if (!data.data) return "";
  const std::vector<ImageView> views = load_image_views(data.run.folder);
  if (views.empty()) return "";
  std::string html =
      "<h4>Images</h4><div class=\"scroll\"><table><thead><tr><th>view [s]</th><th>SSIM</th>"
      "<th>Pearson</th><th>MSE</th><th>Pearson of |gradient|</th><th>observed [%]</th>"
      "<th>scale of the fit</th></tr></thead><tbody>\n";
  std::optional<std::size_t> worst;
  std::vector<std::optional<ImageComparison>> comparisons;
  std::vector<std::optional<ImageScores>> scores;
  for (const ImageView& view : views) {
    comparisons.push_back(compare_image(view, *data.data));
    scores.push_back(comparisons.back() ? score_image(*comparisons.back()) : std::nullopt);
    html += scores_row(view.t_s, scores.back());
    const std::size_t i = scores.size() - 1;
    if (scores[i] && (!worst || scores[i]->ssim < scores[*worst]->ssim)) worst = i;
  }
  html += "</tbody></table></div>\n";
  if (worst) html += view_pictures(views[*worst], *comparisons[*worst], *scores[*worst]);
  return html + growth_pictures(data.run.folder / "growth");
}

}  // namespace saccade
