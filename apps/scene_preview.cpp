#include "apps/scene_preview.h"

#include <fmt/core.h>

#include <vector>

#include "core/config/config.h"
#include "core/error.h"
#include "core/io/images/image_file.h"
#include "eval/picture/preview_sheet.h"
#include "simulator/preview.h"

namespace saccade {
namespace {

/// Three rows of four, and a plan about as wide as two of their pictures.
constexpr int kPreviewViews = 12;
constexpr int kPlanPx = 496;

void print_view(const PreviewView& view) {
  fmt::print("  {:8.3f} s  nearest {:8.3f} m, median {:8.3f} m, {:7.0f} px/s, {:8.3f} M events/s\n",
             view.pose.t_s, view.nearest_m, view.median_m, view.flow_px_per_s,
             1e-6 * view.events_per_s);
}

}  // namespace

void render_preview(const std::string& config_file, const std::filesystem::path& output, bool light,
                    const CommonOptions& common) {
  if (output.extension() != ".png")
    throw InputError(output.string(),
                     "a scene is drawn into a .png file; simulate it to make a video");
  const auto config = config::read<SimulationConfig>(common.load(config_file));
  const ScenePreview seen = preview(config, kPreviewViews, kPlanPx);
  std::vector<PreviewPicture> pictures;
  PlanPicture plan{seen.plan.radiance, seen.plan.centre_m, seen.plan.px_per_m, seen.path, {}};
  double events = 0;
  for (const PreviewView& view : seen.views) {
    pictures.push_back({fmt::format("{:.3f} s", view.pose.t_s), view.radiance});
    plan.views.push_back(view.pose);
    events += view.events_per_s / static_cast<double>(seen.views.size());
    if (!common.quiet) print_view(view);
  }
  write_png(output, draw_preview(std::filesystem::path(config_file).stem().string(), pictures, plan,
                                 light ? kLightTheme : kDarkTheme));
  if (!common.quiet)
    fmt::print("wrote {}: about {:.2g} M events/s on average\n", output.string(), 1e-6 * events);
}

}  // namespace saccade
