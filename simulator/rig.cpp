#include "simulator/rig.h"

#include <fmt/format.h>

#include "core/random.h"

namespace saccade {
namespace {

/// A seed of its own for every camera.
std::uint64_t camera_seed(std::uint64_t seed, std::size_t index) {
  constexpr std::uint64_t kStream = 0x524947ULL << 40;
  if (index == 0) return seed;
  const auto bits = Random(seed).bits(kStream, index);
  return (std::uint64_t{bits[0]} << 32) | bits[1];
}

}  // namespace

std::vector<RigCamera> rig_cameras(const SimulationConfig& config) {
  std::vector<RigCamera> cameras;
  config.camera.check("camera");
  cameras.push_back({config.camera, config.events, Rigid3(), camera_seed(config.seed, 0), {}});
  for (const RigCameraOptions& further : config.rig) {
    const std::size_t index = cameras.size();
    further.camera.check(fmt::format("rig[{}].camera", index - 1));
    cameras.push_back({further.camera, further.events, further.camera0_from_camera,
                       camera_seed(config.seed, index), fmt::format("cam{}", index)});
  }
  return cameras;
}

std::vector<ChainCamera> camera_chain(std::span<const RigCamera> cameras, const ImuOptions& imu) {
  std::vector<ChainCamera> chain;
  for (const RigCamera& camera : cameras) {
    const Rigid3 camera_from_camera0 = camera.camera0_from_camera.inverse();
    ChainCamera link{camera.camera, {}, {}};
    if (imu.rate_hz > 0) link.camera_from_imu = camera_from_camera0 * imu.camera_from_imu;
    if (&camera != &cameras.front())
      link.camera_from_previous = camera_from_camera0 * (&camera - 1)->camera0_from_camera;
    chain.push_back(link);
  }
  return chain;
}

}  // namespace saccade
