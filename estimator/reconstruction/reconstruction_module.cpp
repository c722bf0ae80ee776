#include "estimator/reconstruction/reconstruction_module.h"

#include <fmt/core.h>

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/blind_time.h"
#include "core/config/config.h"
#include "estimator/reconstruction/contrast_thresholds.h"
#include "estimator/reconstruction/reconstruction_config.h"
#include "estimator/reconstruction/reconstruction_output.h"
#include "estimator/reconstruction/surface/depth_source.h"
#include "estimator/reconstruction/thesis_figures.h"
#include "estimator/run/run_input.h"
#include "estimator/run/run_writer.h"
#include "estimator/run/view_run.h"

namespace saccade {
namespace {

std::vector<ReconstructionWindow> make_windows(const ViewInput& input, const Dataset& dataset,
                                               const DepthSource& depth,
                                               const ReconstructionConfig& config,
                                               const ContrastThresholds& thresholds) {
  std::vector<ReconstructionWindow> windows;
  for (const ViewWindow& part :
       cut_windows(input.events(), input.trajectory, config.window, dataset.frames()))
    windows.push_back({part, depth.scene_at(part.reference_s), thresholds});
  return windows;
}

}  // namespace

RunSummary run_reconstruction(const RunRequest& request) {
  auto config = read_config<ReconstructionConfig>(request);
  RunWriter writer(request);

  RunTiming timing;
  const Dataset dataset = Dataset::open(request.dataset);
  const ViewInput input = load_view_input(request, dataset, timing);
  const ContrastThresholds thresholds =
      contrast_thresholds(config.contrast_on, config.contrast_off, dataset, input.events());
  std::optional<double>& blind_time_us = config.observations().blind_time_us;
  if (!blind_time_us)
    blind_time_us =
        find_blind_time_us(input.events(), {dataset.camera().width, dataset.camera().height});
  std::vector<ReconstructionWindow> windows;
  {
    const ScopedTimer clock(timing.io_s);
    const DepthSource depth(dataset, request.depth_from, input.trajectory, config.depth);
    windows = make_windows(input, dataset, depth, config, thresholds);
  }
  const auto estimator = make_image_estimator(config, dataset.camera());
  const auto results = estimate_views<Reconstruction>(
      "reconstruction", windows, request.repeat, timing,
      [&](const ReconstructionWindow& window) { return estimator->reconstruct(window); });
  const auto snapshots = take_snapshots(windows.front().events, config.snapshot_events,
                                        [&](std::span<const Event> events) {
                                          ReconstructionWindow part = windows.front();
                                          part.events = events;
                                          return estimator->reconstruct(part).log_image;
                                        });
  {
    const ScopedTimer clock(timing.io_s);
    write_reconstruction(writer.path(), windows, results, snapshots);
    if (config.figures) write_thesis_figures(writer.path(), dataset, windows.front());
  }
  MethodClass method_class = class_of_views(request, config.window);
  if (!request.depth_from) method_class.inputs.insert(MethodInput::kDepth);
  writer.set_class(method_class);
  if (thresholds.is_found) writer.set_contrast({thresholds.on, thresholds.off});
  writer.finish("reconstruct", request, dataset, input.window, config.seed, config::print(config),
                timing);

  const std::string blind =
      *blind_time_us > 0 ? fmt::format(", pixels blind for {:.2g} ms", 1e-3 * *blind_time_us) : "";
  return summary_of(timing,
                    fmt::format("{} views{}{}", windows.size(), found_text(thresholds), blind));
}

}  // namespace saccade
