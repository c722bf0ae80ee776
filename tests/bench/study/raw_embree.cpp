#include "tests/bench/study/raw_embree.h"

#include <algorithm>
#include <array>
#include <ctime>
#include <limits>
#include <memory>
#include <vector>

#include "core/process/parallel.h"
#include "simulator/scene/intersection/embree_api.h"
#include "simulator/scene/mesh/mesh_import.h"
#include "simulator/scene/mesh_placement.h"
#include "simulator/sensor/rays/pixel_rays.h"

namespace saccade::study {
namespace {

constexpr double kLook_s = 0.05;
constexpr std::size_t kLooks = 11;
constexpr std::size_t kManyTriangles = 500'000;

struct Release {
  void operator()(RTCDevice device) const { rtcReleaseDevice(device); }
  void operator()(RTCScene scene) const { rtcReleaseScene(scene); }
};

/// The triangles of a scene without anything else.
class BareScene {
 public:
  explicit BareScene(const SceneOptions& options)
      : device_(rtcNewDevice("")), scene_(rtcNewScene(device_.get())) {
    MeshImporter importer;
    for (const MeshOptions& mesh : options.meshes)
      if (!mesh.trajectory) add(importer.read(mesh.file), mesh);
    rtcSetSceneBuildQuality(scene_.get(), RTC_BUILD_QUALITY_HIGH);
    rtcSetSceneFlags(scene_.get(), RTC_SCENE_FLAG_ROBUST);
    rtcCommitScene(scene_.get());
  }

  void trace(RTCRayHit16& packet) const {
    alignas(64) static constexpr std::array<int, 16> kAll = [] {
      std::array<int, 16> all{};
      all.fill(-1);
      return all;
    }();
    embree::Query query(triangles_ > kManyTriangles ? embree::Coherence::kIncoherent
                                                    : embree::Coherence::kCoherent);
    embree::intersect16(kAll.data(), scene_.get(), query, packet);
  }

 private:
  void add(const Mesh& mesh, const MeshOptions& options) {
    const Eigen::Affine3d world = world_from_mesh(options, mesh);
    RTCGeometry geometry = rtcNewGeometry(device_.get(), RTC_GEOMETRY_TYPE_TRIANGLE);
    auto* vertices = static_cast<float*>(
        rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                                3 * sizeof(float), mesh.vertices.size()));
    for (const Eigen::Vector3d& vertex : mesh.vertices)
      vertices = std::copy_n((world * vertex).cast<float>().eval().data(), 3, vertices);
    auto* indices = static_cast<unsigned*>(
        rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                                3 * sizeof(unsigned), mesh.triangles.size()));
    for (const Triangle& triangle : mesh.triangles)
      indices = std::copy_n(triangle.corners.data(), 3, indices);
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(scene_.get(), geometry);
    rtcReleaseGeometry(geometry);
    triangles_ += mesh.triangles.size();
  }

  std::unique_ptr<std::remove_pointer_t<RTCDevice>, Release> device_;
  std::unique_ptr<std::remove_pointer_t<RTCScene>, Release> scene_;
  std::size_t triangles_ = 0;
};

using Packet = std::array<Ray, kTilePixels>;

/// Of all whole tiles.
std::vector<Packet> primary_rays(const Scenario& scenario) {
  const PixelRays rays(scenario.config.camera, 1);
  const double t_s = 0.5 * scenario.motion.end_s();
  const Rigid3 pose = scenario.motion.pose(t_s);
  std::vector<Packet> packets;
  for (std::size_t i = 0; i < rays.tile_count(); ++i) {
    const std::span<const Eigen::Vector3d> directions = rays.rays(i);
    if (directions.size() < kTilePixels) continue;
    Packet& packet = packets.emplace_back();
    for (std::size_t k = 0; k < kTilePixels; ++k)
      packet[k] = {pose.translation(), pose.rotation() * directions[k], t_s};
  }
  return packets;
}

RTCRayHit16 embree_packet(const Packet& rays) {
  RTCRayHit16 packet{};
  for (std::size_t k = 0; k < kTilePixels; ++k) {
    packet.ray.org_x[k] = static_cast<float>(rays[k].origin.x());
    packet.ray.org_y[k] = static_cast<float>(rays[k].origin.y());
    packet.ray.org_z[k] = static_cast<float>(rays[k].origin.z());
    packet.ray.dir_x[k] = static_cast<float>(rays[k].direction.x());
    packet.ray.dir_y[k] = static_cast<float>(rays[k].direction.y());
    packet.ray.dir_z[k] = static_cast<float>(rays[k].direction.z());
    packet.ray.tfar[k] = std::numeric_limits<float>::infinity();
    packet.ray.mask[k] = ~0U;
    packet.hit.geomID[k] = RTC_INVALID_GEOMETRY_ID;
    packet.hit.instID[0][k] = RTC_INVALID_GEOMETRY_ID;
  }
  return packet;
}

/// Rays per processor second of trace(index of a packet) over all packets, the middle one of some
/// looks.
template <class Trace>
double rate(std::size_t packets, const Trace& trace) {
  std::array<double, kLooks> rates;
  for (double& rate : rates) {
    const std::clock_t start = std::clock();
    double rays = 0;
    double elapsed_s = 0;
    while (elapsed_s < kLook_s) {
      parallel_for(packets, trace, 64);
      rays += static_cast<double>(packets * kTilePixels);
      elapsed_s = static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
    }
    rate = rays / elapsed_s;
  }
  std::sort(rates.begin(), rates.end());
  return rates[kLooks / 2];
}

}  // namespace

RayRates measure_ray_rates(const Scenario& scenario) {
  const BareScene bare(scenario.config.scene);
  const std::vector<Packet> rays = primary_rays(scenario);
  std::vector<RTCRayHit16> packets;
  for (const Packet& packet : rays) packets.push_back(embree_packet(packet));
  return {rate(packets.size(),
               [&](std::size_t i) {
                 alignas(64) RTCRayHit16 packet = packets[i];
                 bare.trace(packet);
               }),
          rate(rays.size(), [&](std::size_t i) {
            std::array<TriangleId, kTilePixels> triangles;
            scenario.scene.visible(rays[i], triangles);
          })};
}

}  // namespace saccade::study
