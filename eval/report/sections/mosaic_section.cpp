#include "eval/report/sections/module_sections.h"

#include <fmt/format.h>

#include "eval/mosaic_view.h"
#include "eval/picture/view/mosaic_picture.h"
#include "eval/report/html.h"
#include "eval/table/number_text.h"

namespace saccade {
namespace {

std::string scores_table(const Metrics& metrics) {
  const auto cell = [&](const char* key) {
    return fmt::format("<td>{}</td>", fixed(metrics.get(std::string("mosaic.") + key), 3));
  };
  return "<h4>Mosaic</h4><div class=\"scroll\"><table><thead><tr><th>aligned by</th><th>SSIM</th>"
         "<th>Pearson</th></tr></thead><tbody>\n<tr><td>the orientation at the start</td>" +
         cell("ssim") + cell("pearson") + "</tr>\n<tr><td>the mean orientation</td>" +
         cell("aligned.ssim") + cell("aligned.pearson") +
         fmt::format(
             "</tr></tbody></table></div>\n<p class=\"note\">The two alignments differ by "
             "{} degrees; after the second the orientations have an error of {} degrees RMS. The "
             "mosaic spans {} fields of view by area, {} by width, and observed {} of what "
             "came into view.</p>\n",
             significant(metrics.get("mosaic.alignment.rotation_deg")),
             significant(metrics.get("mosaic.alignment.residual_deg")),
             significant(metrics.get("mosaic.span.solid_angle")),
             significant(metrics.get("mosaic.span.horizontal")),
             fixed(metrics.get("mosaic.observed"), 3));
}

}  // namespace

std::string mosaic_section(const RunData& data) {
  if (!data.data) return "";
  const auto mosaic = load_mosaic(data.run);
  if (!mosaic) return "";
  std::string html = scores_table(data.metrics);
  for (const CaptionedPicture& picture : mosaic_pictures(*mosaic, data.run, *data.data))
    html += figure(picture.image, picture.caption, picture.caption);
  return html + growth_pictures(data.run.folder, 1);
}

}  // namespace saccade
