#include "eval/report/sections/module_sections.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "eval/keyframe_history.h"
#include "eval/metrics/trajectory/keyframe_metrics.h"
#include "eval/picture/image/depth_picture.h"
#include "eval/picture/image/path_picture.h"
#include "eval/picture/view/view_pictures.h"
#include "eval/report/html.h"
#include "eval/table/number_text.h"
#include "eval/table/table.h"

namespace saccade {
namespace {

std::string active_list(const KeyframeEntry& keyframe) {
  std::string list;
  for (const std::int64_t i : keyframe.active)
    list += fmt::format("{}{}", list.empty() ? "" : ", ", i);
  return list;
}

std::string keyframe_table(const RunData& data, std::span<const KeyframeEntry> keyframes) {
  const std::vector<KeyframeJump> jumps = keyframe_jumps(keyframes, data.input);
  Table table{data.id + "_keyframes", "Keyframes"};
  table.add_numeric({"keyframe", "view [s]", "made until [s]", "taken at [s]", "events", "points",
                     "edges", "median depth [m]", "map", "jump [mm]", "jump [deg]"});
  table.columns[8].numeric = false;
  for (std::size_t i = 0; i < keyframes.size(); ++i) {
    const KeyframeEntry& k = keyframes[i];
    auto& row = table.rows.emplace_back();
    const auto add = [&](const std::optional<double>& value, int decimals) {
      row.push_back(number_cell(value, decimals == 0 ? grouped(value) : fixed(value, decimals)));
    };
    add(static_cast<double>(i), 0);
    for (const double t_s : {k.t_s, k.made_s, k.taken_s}) add(t_s, 3);
    for (const auto count : {k.events, k.points, k.edges}) add(static_cast<double>(count), 0);
    add(k.typical_depth_m, 2);
    row.push_back({active_list(k)});
    const auto jump = std::find_if(jumps.begin(), jumps.end(),
                                   [&](const KeyframeJump& each) { return each.t_s == k.taken_s; });
    const bool has_jump = jump != jumps.end();
    add(has_jump ? std::optional(1e3 * jump->position_m) : std::nullopt, 2);
    add(has_jump ? std::optional(jump->rotation_deg) : std::nullopt, 3);
  }
  return table_html(table) +
         "<p class=\"note\">Map: the keyframes whose edges are tracked from "
         "then on. Jump: change of the pose&rsquo;s error where the keyframe is taken.</p>\n";
}

std::string path_figure(const RunData& data, std::span<const KeyframeEntry> keyframes) {
  if (data.input.estimate.empty()) return "";
  const TopDownPath path(data.input.truth, data.truth_from_estimate * data.input.estimate, 640, 480,
                         kLightTheme);
  std::vector<Eigen::Vector3d> positions;
  for (const KeyframeEntry& keyframe : keyframes)
    positions.push_back(data.truth_from_estimate * keyframe.world_from_camera.translation());
  return figure(path.draw(data.input.estimate.end_s(), positions),
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
