#include "estimator/refinement/refinement_module.h"

#include <fmt/core.h>

#include "core/config/config.h"
#include "core/error.h"
#include "estimator/refinement/refine_depth.h"
#include "estimator/refinement/refine_joint.h"
#include "estimator/refinement/refine_poses.h"
#include "estimator/refinement/refinement_config.h"
#include "estimator/refinement/source_run.h"
#include "estimator/run/run_input.h"
#include "estimator/run/run_writer.h"

namespace saccade {
namespace {

using Kind = RefinementConfig::Kind;

Kind kind_of(const RefinementConfig& config, const SourceRun& run) {
  if (config.kind != Kind::kOfRun) return config.kind;
  if (run.record.module == "track") return Kind::kPoses;
  if (run.record.module == "depth") return Kind::kDepth;
  if (run.record.module == "odometry") return Kind::kJoint;
  throw InputError(run.folder.string(),
                   fmt::format("is a run of {}; track, depth and odometry can be refined (--from)",
                               run.record.module));
}

}  // namespace

RunSummary run_refinement(const RunRequest& request) {
  auto config = config::read<RefinementConfig>(request.config);
  if (request.seed) config.seed = *request.seed;
  check(request);
  RunWriter writer(request);
  const Dataset dataset = Dataset::open(request.dataset);
  const SourceRun run = SourceRun::open(request, dataset);
  config.kind = kind_of(config, run);
  if (config.kind != Kind::kDepth && request.poses_from)
    throw InputError("--poses-from", "poses are refined here; it is of a run of depth");
  if (config.kind == Kind::kDepth) return refine_depth(request, config, dataset, run, writer);
  if (config.kind == Kind::kJoint) return refine_joint(request, config, dataset, run, writer);
  return refine_poses(request, config, dataset, run, writer);
}

std::string print_refinement_config(const config::Document& document) {
  return config::print_documented(config::read<RefinementConfig>(document));
}

}  // namespace saccade
