#include "eval/report/sections/module_sections.h"

#include <vector>

#include "eval/picture/view/reconstruction_stages.h"
#include "eval/report/html.h"

namespace saccade {
namespace {

std::string group(const std::string& title, const std::vector<CaptionedPicture>& pictures) {
  if (pictures.empty()) return "";
  std::string html = "<h4>" + title + "</h4><div class=\"grid three\">";
  for (const CaptionedPicture& drawn : pictures)
    html += figure(drawn.image, drawn.caption, drawn.caption);
  return html + "</div>\n";
}

}  // namespace

std::string reconstruction_stage_section(const RunData& data) {
  if (!data.data) return "";
  return group("Poisson's equation: true gradients in, image out",
               poisson_pictures(data.run.folder, kUpscale)) +
         group("Depth of the view carried to another by kernels of several sizes",
               propagation_pictures(data.run.folder, *data.data, kUpscale, kDarkTheme));
}

}  // namespace saccade
