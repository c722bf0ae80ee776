#include "estimator/registry.h"

#include "core/config/config.h"
#include "core/error.h"
#include "estimator/depth/depth_config.h"
#include "estimator/depth/depth_module.h"
#include "estimator/external/adapter_config.h"
#include "estimator/external/external_module.h"
#include "estimator/imu/stabilize_config.h"
#include "estimator/imu/stabilize_module.h"
#include "estimator/mosaic/mosaic_config.h"
#include "estimator/mosaic/mosaic_module.h"
#include "estimator/odometry/odometry_config.h"
#include "estimator/odometry/odometry_module.h"
#include "estimator/reconstruction/reconstruction_config.h"
#include "estimator/reconstruction/reconstruction_module.h"
#include "estimator/refinement/refinement_config.h"
#include "estimator/refinement/refinement_module.h"
#include "estimator/rotation/rotation_config.h"
#include "estimator/rotation/rotation_module.h"
#include "estimator/tracking/track_config.h"
#include "estimator/tracking/track_module.h"

namespace saccade {
namespace {

constexpr Module kModules[] = {
    {"track", "pose of the camera against a known map (thesis chapter 4)", false, false, false,
     run_track, print_track_config, config::reference<TrackConfig>},
    {"depth", "depth of the edges from events and poses (thesis chapter 5)", true, false, false,
     run_depth, print_depth_config, config::reference<DepthConfig>},
    {"reconstruct", "image of a view from events, poses and depth (thesis chapter 6)", true, true,
     false, run_reconstruction, print_reconstruction_config,
     config::reference<ReconstructionConfig>},
    {"odometry", "poses and map from events and the poses of a short start (thesis chapter 7)",
     false, false, false, run_odometry, print_odometry_config, config::reference<OdometryConfig>},
    {"refine", "batch optimum beside a run of track, depth or odometry, which --from names", true,
     false, true, run_refinement, print_refinement_config, config::reference<RefinementConfig>},
    {"stabilize", "events and frames as of a camera that does not turn (thesis chapter 3)", true,
     false, false, run_stabilization, print_stabilization_config,
     config::reference<StabilizeConfig>},
    {"mosaic", "panorama from the events of a camera that only turns (thesis 3.4.1)", true, false,
     false, run_mosaic, print_mosaic_config, config::reference<MosaicConfig>},
    {"rotation", "angular velocity of the camera from events, gyroscope or both", false, false,
     false, run_rotation, print_rotation_config, config::reference<RotationConfig>},
    {"external", "a program of somebody else, which an adapter (-c) says how to run", false, false,
     false, run_external, print_external_config, config::reference<AdapterConfig>},
};

}  // namespace

std::span<const Module> modules() { return kModules; }

const Module& find_module(const std::string& name) {
  std::string known;
  for (const Module& module : modules()) {
    if (name == module.name) return module;
    known += known.empty() ? module.name : std::string(", ") + module.name;
  }
  throw InputError("MODULE", "there is no estimator '" + name + "'; there are: " + known);
}

RunSummary run_module(const std::string& name, const RunRequest& request) {
  const Module& module = find_module(name);
  if (request.poses_from && !module.takes_poses)
    throw InputError("--poses-from", std::string(name) + " takes no poses");
  if (request.depth_from && !module.takes_depth)
    throw InputError("--depth-from", std::string(name) + " takes no depth");
  if (request.from && !module.takes_run)
    throw InputError("--from", std::string(name) + " refines no run");
  return module.run(request);
}

}  // namespace saccade
