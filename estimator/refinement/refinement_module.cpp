#include "estimator/refinement/refinement_module.h"

#include <fmt/core.h>

#include <algorithm>
#include <filesystem>

#include "core/config/config.h"
#include "core/error.h"
#include "estimator/refinement/refinement_config.h"
#include "estimator/refinement/source_run.h"
#include "estimator/run/run_input.h"
#include "estimator/run/run_writer.h"

namespace saccade {
namespace {

/// The method that the configuration names, or that fits the run.
const RefinementMethod& method_of(const RefinementConfig& config, const SourceRun& run) {
  const auto fits = [&](const RefinementMethod& method) {
    return config.method == "of_run" ? method.module == run.record.module
                                     : method.name == config.method;
  };
  const auto methods = refinement_methods();
  const auto found = std::find_if(methods.begin(), methods.end(), fits);
  if (found == methods.end())
    throw InputError(run.folder.string(), fmt::format("is a run of {}; track, depth and odometry "
                                                      "can be refined (--from)",
                                                      run.record.module));
  return *found;
}

}  // namespace

RunSummary run_refinement(const RunRequest& request) {
  auto config = config::read<RefinementConfig>(request.config);
  if (request.seed) config.seed = *request.seed;
  check(request);
  RunWriter writer(request);
  const Dataset dataset = Dataset::open(request.dataset);
  const SourceRun run = SourceRun::open(request, dataset);
  const RefinementMethod& method = method_of(config, run);
  config.method = method.name;
  if (config.method != "depth" && request.poses_from)
    throw InputError("--poses-from", "poses are refined here; it is of a run of depth");
  if (config.method != "depth")
    refuse_smoothing(request, "poses are refined here; it is of a run of depth");
  // A run that found its own start has a world of its own, in metres or not, and so has this one.
  if (std::filesystem::exists(run.folder / "start.yaml"))
    for (const char* name : {"start.yaml", "inertial.yaml"})
      if (std::filesystem::exists(run.folder / name))
        std::filesystem::copy_file(run.folder / name, writer.path() / name);
  MethodClass method_class{{MethodInput::kEvents}, Processing::kBatch};
  if (config.method == "joint" && config.joint.use_imu)
    method_class.inputs.insert(MethodInput::kImu);
  writer.set_class(method_class);
  return method.run(request, config, dataset, run, writer);
}

}  // namespace saccade
