#include "estimator/reconstruction/reconstruction_module.h"

#include <fmt/core.h>

#include <algorithm>
#include <optional>
#include <vector>

#include "core/config/config.h"
#include "core/error.h"
#include "core/parallel.h"
#include "estimator/reconstruction/depth_source.h"
#include "estimator/reconstruction/reconstruction_config.h"
#include "estimator/reconstruction/reconstruction_output.h"
#include "estimator/run_input.h"
#include "estimator/run_writer.h"
#include "estimator/view_run.h"

namespace saccade {
namespace {

/// The threshold of the configuration, else the dataset's.
double contrast_of(const std::optional<double>& configured, const std::optional<double>& stated,
                   const Dataset& dataset, const char* key) {
  if (configured) return *configured;
  if (!stated)
    throw InputError(dataset.folder().string(),
                     fmt::format("does not state its contrast thresholds; state {}", key));
  return *stated;
}

std::vector<ReconstructionWindow> make_windows(const ViewInput& input, const Dataset& dataset,
                                               const DepthSource& depth,
                                               const ReconstructionConfig& config) {
  const DatasetFacts& facts = dataset.facts();
  const double on = contrast_of(config.contrast_on, facts.contrast_on, dataset, "contrast_on");
  const double off = contrast_of(config.contrast_off, facts.contrast_off, dataset, "contrast_off");
  std::vector<ReconstructionWindow> windows;
  for (const ViewWindow& part :
       cut_windows(input.events(), input.trajectory, config.window, dataset.frames()))
    windows.push_back({part, depth.scene_at(part.reference_s), on, off});
  return windows;
}

/// The first window from fewer events, as in thesis figs. 8.14 and 8.15.
std::vector<GrowthPicture> grow(const ImageEstimator& estimator, const ReconstructionWindow& window,
                                const std::vector<std::int64_t>& counts) {
  std::vector<GrowthPicture> pictures(counts.size());
  parallel_for(counts.size(), [&](std::size_t i) {
    ReconstructionWindow part = window;
    const auto count = std::min(window.events.size(),
                                static_cast<std::size_t>(std::max<std::int64_t>(counts[i], 1)));
    part.events = window.events.first(count);
    pictures[i] = {count, estimator.reconstruct(part).log_image};
  });
  return pictures;
}

}  // namespace

RunSummary run_reconstruction(const RunRequest& request) {
  ReconstructionConfig config = config::read<ReconstructionConfig>(request.config);
  if (request.seed) config.seed = *request.seed;
  check(request);
  RunWriter writer(request);

  RunTiming timing;
  const Dataset dataset = Dataset::open(request.dataset);
  const ViewInput input = load_view_input(request, dataset, timing);
  std::vector<ReconstructionWindow> windows;
  {
    const StageClock clock(timing.io_s);
    const DepthSource depth(dataset, request.depth_from, input.trajectory, config.depth);
    windows = make_windows(input, dataset, depth, config);
  }
  const auto estimator = make_image_estimator(config, dataset.camera());
  const auto results = estimate_views<Reconstruction>(
      "reconstruction", windows, request.repeat, timing,
      [&](const ReconstructionWindow& window) { return estimator->reconstruct(window); });
  const auto growth = grow(*estimator, windows.front(), config.growth);
  {
    const StageClock clock(timing.io_s);
    write_reconstruction(writer.path(), windows, results, growth);
  }
  writer.finish("reconstruct", request, dataset, input.window, config.seed, config::print(config),
                timing);

  RunSummary summary;
  summary.found = fmt::format("{} views", windows.size());
  summary.events = timing.events;
  summary.wall_s = median(timing.wall_s);
  return summary;
}

std::string print_reconstruction_config(const config::Document& document) {
  return config::print_documented(config::read<ReconstructionConfig>(document));
}

}  // namespace saccade
