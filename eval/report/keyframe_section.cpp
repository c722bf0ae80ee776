#include "eval/report/keyframe_section.h"

#include <fmt/format.h>

#include <cmath>
#include <filesystem>
#include <vector>

#include "core/io/keyframe_list.h"
#include "eval/metrics/keyframe_metrics.h"
#include "eval/number_text.h"
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

}  // namespace

std::string keyframe_section(const RunData& data) {
  const std::filesystem::path file = data.run.folder / "keyframes.yaml";
  if (!std::filesystem::exists(file)) return "";
  const std::vector<KeyframeEntry> keyframes = read_keyframe_list(file);
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

}  // namespace saccade
