#include "eval/report/sections/module_sections.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <numeric>
#include <optional>
#include <vector>

#include "eval/depth_views.h"
#include "eval/picture/image/depth_picture.h"
#include "eval/picture/view/derotation_pictures.h"
#include "eval/picture/view/view_pictures.h"
#include "eval/report/html.h"
#include "eval/table/number_text.h"
#include "eval/table/table.h"

namespace saccade {
namespace {

std::string percent(const Metrics& metrics, const char* key, int decimals = 2) {
  std::optional<double> value = metrics.get(key);
  if (value) *value *= 100;
  return fixed(value, decimals);
}

std::string views_table(const RunData& data, const std::vector<DepthErrors>& views) {
  Table table{data.id + "_depth_views", "Depth, view by view"};
  table.add_numeric({"view [s]", "points", "median [%]", "mean [%]", "over 5 % [%]",
                     "strict median [%]", "strict mean [%]", "completeness [%]",
                     "within 1 sigma [%]", "within 2 sigma [%]"});
  for (const DepthErrors& view : views) {
    const Metrics m = view_scores(view);
    const auto points = static_cast<double>(view.points);
    auto& row = table.rows.emplace_back();
    row = {number_cell(view.t_s, fixed(view.t_s, 3)), number_cell(points, grouped(points))};
    for (const char* key : {"rel_median", "rel_mean", "outlier_5_percent", "strict.rel_median",
                            "strict.rel_mean", "completeness", "within_1_sigma", "within_2_sigma"})
      row.push_back(number_cell(m.get(key), percent(m, key)));
  }
  return table_html(table);
}

/// By mean relative error; views without a point come last.
std::vector<std::size_t> from_best_to_worst(const std::vector<DepthErrors>& views) {
  std::vector<double> errors;
  errors.reserve(views.size());
  for (const DepthErrors& view : views)
    errors.push_back(view_scores(view).get("rel_mean").value_or(1e9));
  std::vector<std::size_t> order(views.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return errors[a] < errors[b]; });
  return order;
}

std::string view_pictures(const RunData& data, const EstimatedView& view, const char* which) {
  std::string html = "<div class=\"grid three\">";
  for (const CaptionedPicture& picture : depth_pictures(view, *data.data, kUpscale, kDarkTheme))
    html += figure(picture.image,
                   fmt::format("{} view, {:.3f} s: {}", which, view.t_s, picture.caption),
                   picture.caption);
  return html + "</div>\n";
}

/// Events around the view as they came and rotated into its orientation (thesis fig. 5.2).
std::string derotation_figures(const RunData& data, const EstimatedView& view) {
  std::string html;
  for (const CaptionedPicture& drawn : derotation_pictures(*data.data, view.t_s, kUpscale))
    html += figure(drawn.image, drawn.caption, drawn.caption);
  return html.empty() ? "" : "<div class=\"grid three\">" + html + "</div>\n";
}

std::string planes_table(const std::vector<FittedPlane>& planes, std::size_t points) {
  if (planes.size() < 2) return "";
  std::string html =
      "<div class=\"scroll\"><table><thead><tr><th></th><th>points [%]</th>"
      "<th>to 1 [deg]</th><th>to 2 [deg]</th></tr></thead><tbody>\n";
  for (std::size_t i = 0; i < planes.size(); ++i)
    html += fmt::format(
        "<tr><td>{}</td><td>{:.1f}</td><td>{:.2f}</td><td>{:.2f}</td></tr>\n", i + 1,
        100 * static_cast<double>(planes[i].points.size()) / static_cast<double>(points),
        angle_between_deg(planes[i].plane, planes[0].plane),
        angle_between_deg(planes[i].plane, planes[1].plane));
  return html + "</tbody></table></div>";
}

std::string cloud(const RunData& data, const std::vector<EstimatedView>& views) {
  const PinholeCamera& camera = data.data->camera();
  std::vector<Eigen::Vector3d> points = points_in_world(views, camera);
  const Rigid3 camera_from_world = views[views.size() / 2].world_from_camera.inverse();
  for (Eigen::Vector3d& point : points) point = camera_from_world * point;
  return "<div class=\"grid\">" +
         figure(draw_top_down(points, 480, 360, kLightTheme),
                "All points from above the camera of the view in the middle", "cloud from above") +
         "<div><h4>Planes that most points lie on, angles between them</h4>" +
         planes_table(planes_of(views, camera), points.size()) + "</div></div>\n";
}

}  // namespace

std::string depth_section(const RunData& data) {
  if (!data.data) return "";
  const std::vector<EstimatedView> views = load_depth_views(data.run, *data.data);
  if (views.empty()) return "";
  const std::vector<DepthErrors> errors = compare_views(views, *data.data);
  std::string html = views_table(data, errors) +
                     "<p class=\"note\">Relative errors against the best pixel of the 3 x 3 around "
                     "a point; strict: at its exact position.</p>";
  const std::vector<std::size_t> order = from_best_to_worst(errors);
  const std::size_t middle = order[(order.size() - 1) / 2];
  html += view_pictures(data, views[middle], "Median");
  if (order.size() > 1) html += view_pictures(data, views[order.back()], "Worst");
  return html + derotation_figures(data, views[middle]) + cloud(data, views);
}

}  // namespace saccade
