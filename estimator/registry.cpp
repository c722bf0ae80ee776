#include "estimator/registry.h"

#include "core/config/config.h"
#include "core/config/suggest.h"
#include "core/error.h"
#include "estimator/depth/depth_config.h"
#include "estimator/depth/depth_module.h"
#include "estimator/external/adapter_config.h"
#include "estimator/external/external_module.h"
#include "estimator/imu/stabilize_module.h"
#include "estimator/mosaic/mosaic_config.h"
#include "estimator/mosaic/mosaic_module.h"
#include "estimator/odometry/odometry_config.h"
#include "estimator/odometry/odometry_module.h"
#include "estimator/reconstruction/reconstruction_config.h"
#include "estimator/reconstruction/reconstruction_module.h"
#include "estimator/refinement/refinement_config.h"
#include "estimator/refinement/refinement_module.h"
#include "estimator/rotation/rotation_module.h"
#include "estimator/tracking/track_config.h"
#include "estimator/tracking/track_module.h"

namespace saccade {
namespace {

/// The resolved configuration, documented, as YAML.
template <class Config>
std::string print_config(const config::Document& document) {
  return config::print_documented(config::read<Config>(document));
}

constexpr Module kModules[] = {
    {.name = "track",
     .help = "Pose of the camera against a known map (thesis chapter 4).",
     .run = run_track,
     .print_config = print_config<TrackConfig>,
     .reference = config::reference<TrackConfig>},
    {.name = "depth",
     .help = "Depth of the edges from events and poses (thesis chapter 5).",
     .takes_poses = true,
     .run = run_depth,
     .print_config = print_config<DepthConfig>,
     .reference = config::reference<DepthConfig>},
    {.name = "reconstruct",
     .help = "Image of a view from events, poses and depth (thesis chapter 6).",
     .takes_poses = true,
     .takes_depth = true,
     .run = run_reconstruction,
     .print_config = print_config<ReconstructionConfig>,
     .reference = config::reference<ReconstructionConfig>},
    {.name = "odometry",
     .help = "Poses and map from events and the poses of a short start (thesis chapter 7).",
     .takes_poses = true,
     .run = run_odometry,
     .print_config = print_config<OdometryConfig>,
     .reference = config::reference<OdometryConfig>},
    {.name = "refine",
     .help = "Batch optimum beside a run of track, depth or odometry, which --from names.",
     .takes_poses = true,
     .takes_run = true,
     .run = run_refinement,
     .print_config = print_config<RefinementConfig>,
     .reference = config::reference<RefinementConfig>},
    {.name = "stabilize",
     .help = "Events and frames as of a camera that does not rotate (thesis chapter 3).",
     .takes_poses = true,
     .run = run_stabilization,
     .print_config = print_config<StabilizeConfig>,
     .reference = config::reference<StabilizeConfig>},
    {.name = "mosaic",
     .help = "Panorama from the events of a rotating camera (thesis 3.4.1).",
     .takes_poses = true,
     .run = run_mosaic,
     .print_config = print_config<MosaicConfig>,
     .reference = config::reference<MosaicConfig>},
    {.name = "rotation",
     .help = "Angular velocity of the camera from events, gyroscope or both.",
     .run = run_rotation,
     .print_config = print_config<RotationConfig>,
     .reference = config::reference<RotationConfig>},
    {.name = "external",
     .help = "An external program, which an adapter (-c) says how to run.",
     .run = run_external,
     .print_config = print_config<AdapterConfig>,
     .reference = config::reference<AdapterConfig>},
};

}  // namespace

std::span<const Module> modules() { return kModules; }

const Module& find_module(const std::string& name) {
  std::vector<std::string> known;
  for (const Module& module : modules()) {
    if (name == module.name) return module;
    known.emplace_back(module.name);
  }
  const auto meant = config::nearest(name, known);
  throw InputError("MODULE",
                   "there is no estimator '" + name + "'; " +
                       (meant ? "did you mean '" + *meant + "'? There are: " : "there are: ") +
                       config::joined(known));
}

RunSummary run_module(const std::string& name, const RunRequest& request) {
  const Module& module = find_module(name);
  if (request.poses_from && !module.takes_poses)
    throw InputError("--poses-from", std::string(name) + " takes no poses");
  if (request.smooth_poses_s && !module.takes_poses)
    throw InputError("--smooth-poses", std::string(name) + " takes no poses");
  if (request.depth_from && !module.takes_depth)
    throw InputError("--depth-from", std::string(name) + " takes no depth");
  if (request.from && !module.takes_run)
    throw InputError("--from", std::string(name) + " refines no run");
  return module.run(request);
}

}  // namespace saccade
