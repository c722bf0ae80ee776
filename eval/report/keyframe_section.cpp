#include "eval/report/keyframe_section.h"

#include <fmt/format.h>

#include <span>
#include <vector>

#include "eval/keyframe_history.h"
#include "eval/metrics/keyframe_metrics.h"
#include "eval/number_text.h"
#include "eval/picture/image/depth_picture.h"
#include "eval/picture/image/path_picture.h"
#include "eval/picture/view/view_pictures.h"
#include "eval/report/html.h"

namespace saccade {
namespace {

/// The jump at a keyframe's taking as two cells; dashes where there is none.
std::string jump_cells(const std::vector<KeyframeJump>& jumps, double taken_s) {
  for (const KeyframeJump& jump : jumps)
    if (jump.t_s == taken_s)
      return fmt::format("<td>{:.2f}</td><td>{:.3f}</td>", 1e3 * jump.position_m, jump.turn_deg);
  return "<td>-</td><td>-</td>";
}

std::string active_list(const KeyframeEntry& keyframe) {
  std::string list;
  for (const std::int64_t i : keyframe.active)
    list += fmt::format("{}{}", list.empty() ? "" : ", ", i);
  return list;
}

std::string keyframe_table(const RunData& data, std::span<const KeyframeEntry> keyframes) {
  const std::vector<KeyframeJump> jumps = keyframe_jumps(keyframes, data.input);
  std::string html =
      "<h4>Keyframes</h4><div class=\"scroll\"><table><thead><tr><th></th><th>view [s]</th>"
      "<th>made until [s]</th><th>taken at [s]</th><th>events</th><th>points</th><th>edges</th>"
      "<th>median depth [m]</th><th>map</th><th>jump [mm]</th><th>jump [deg]</th></tr></thead>"
      "<tbody>\n";
  for (std::size_t i = 0; i < keyframes.size(); ++i) {
    const KeyframeEntry& k = keyframes[i];
    html += fmt::format(
        "<tr><td>{}</td><td>{:.3f}</td><td>{:.3f}</td><td>{:.3f}</td><td>{}</td><td>{}</td>"
        "<td>{}</td><td>{:.2f}</td><td>{}</td>{}</tr>\n",
        i, k.t_s, k.made_s, k.taken_s, grouped(static_cast<double>(k.events)),
        grouped(static_cast<double>(k.points)), grouped(static_cast<double>(k.edges)),
        k.typical_depth_m, active_list(k), jump_cells(jumps, k.taken_s));
  }
  return html +
         "</tbody></table></div><p class=\"note\">Map: the keyframes whose edges are tracked from "
         "then on. Jump: change of the pose&rsquo;s error where the keyframe is taken.</p>\n";
}

std::string path_figure(const RunData& data, std::span<const KeyframeEntry> keyframes) {
  if (data.input.estimate.empty()) return "";
  const TopDownPath path(data.input.truth, data.input.estimate, 640, 480, kLightTheme);
  std::vector<Eigen::Vector3d> places;
  for (const KeyframeEntry& keyframe : keyframes)
    places.push_back(keyframe.world_from_camera.translation());
  return figure(path.draw(data.input.estimate.end_s(), places),
                "The path from above: truth (grey), estimate (orange), keyframes (blue)",
                "path from above");
}

/// Depth in the colours of its own range.
std::string depth_figure(const RunData& data, const EstimatedView& view, std::size_t keyframe) {
  const DepthRange range = depth_range(view.points);
  return figure(draw_depth_points(view.points, data.data->camera(), range, kUpscale, kDarkTheme),
                fmt::format("{}: depth at {:.3f} s, {} m (bright) to {} m (dark)", keyframe,
                            view.t_s, significant(range.near_m), significant(range.far_m)),
                "depth of a keyframe");
}

std::string gallery(const RunData& data, const KeyframeHistory& history) {
  constexpr std::size_t kMost = 8;
  std::string depths, images;
  for (const std::size_t i : evenly_spaced_indices(history.keyframes().size(), kMost)) {
    depths += depth_figure(data, history.depth(i), i);
    // Only the depth has text in it; the browser enlarges the image.
    if (const ImageView* const image = history.image(i))
      images += figure(draw_image_alone(*image, 1),
                       fmt::format("{}: image at {:.3f} s", i, image->t_s), "image of a keyframe");
  }
  const auto grid = [](const std::string& figures) {
    return figures.empty() ? "" : "<div class=\"grid four\">" + figures + "</div>\n";
  };
  return "<h4>Depth and images of keyframes</h4>" + grid(depths) + grid(images);
}

}  // namespace

std::string keyframe_section(const RunData& data) {
  if (!data.data || !data.keyframes) return "";
  const std::span<const KeyframeEntry> keyframes = data.keyframes->keyframes();
  return keyframe_table(data, keyframes) + "<div class=\"grid\">" + path_figure(data, keyframes) +
         "</div>\n" + gallery(data, *data.keyframes);
}

}  // namespace saccade
