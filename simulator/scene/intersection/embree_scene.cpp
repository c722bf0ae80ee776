#include "simulator/scene/intersection/embree_scene.h"

#include <embree3/rtcore.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <limits>
#include <type_traits>
#include <utility>

#include "core/check.h"

namespace saccade {
namespace {

/// Beyond this many triangles Embree's coherent traversal loses against the incoherent one.
constexpr std::size_t kCoherentTriangles = 500'000;

/// Without -march=native the build promises equal results everywhere, and Embree must not pick what
/// this processor has. Its option "threads" would hold back every other use of TBB in the process.
#ifdef __AVX2__
constexpr const char* kDeviceOptions = "";
#else
constexpr const char* kDeviceOptions = "isa=sse4.2";
#endif

struct ReleaseDevice {
  void operator()(RTCDevice device) const { rtcReleaseDevice(device); }
};
struct ReleaseScene {
  void operator()(RTCScene scene) const { rtcReleaseScene(scene); }
};
using DeviceHandle = std::unique_ptr<std::remove_pointer_t<RTCDevice>, ReleaseDevice>;
using SceneHandle = std::unique_ptr<std::remove_pointer_t<RTCScene>, ReleaseScene>;

/// Embree's context with the rays in double precision, for the cutout test.
struct Context {
  RTCIntersectContext embree;
  const Ray* rays;

  Context(const Ray* all_rays, RTCIntersectContextFlags flags) : rays(all_rays) {
    rtcInitIntersectContext(&embree);
    embree.flags = flags;
  }
};

void add_triangles(RTCDevice device, RTCScene scene, std::span<const Corners> corners,
                   unsigned geometry_id, RTCFilterFunctionN filter, void* user) {
  if (corners.empty()) return;
  RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
  auto* vertices = static_cast<float*>(rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0,
                                                               RTC_FORMAT_FLOAT3, 3 * sizeof(float),
                                                               3 * corners.size()));
  auto* indices = static_cast<unsigned*>(rtcSetNewGeometryBuffer(
      geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 3 * sizeof(unsigned), corners.size()));
  SACCADE_CHECK(vertices != nullptr && indices != nullptr);
  for (const Corners& triangle : corners)
    for (const Eigen::Vector3f& corner : triangle)
      vertices = std::copy_n(corner.data(), 3, vertices);
  for (unsigned i = 0; i < 3 * corners.size(); ++i) indices[i] = i;
  if (filter != nullptr) {
    rtcSetGeometryUserData(geometry, user);
    rtcSetGeometryIntersectFilterFunction(geometry, filter);
    rtcSetGeometryOccludedFilterFunction(geometry, filter);
  }
  rtcCommitGeometry(geometry);
  rtcAttachGeometryByID(scene, geometry, geometry_id);
  rtcReleaseGeometry(geometry);
}

RTCRayHit16 make_empty_packet() {
  RTCRayHit16 packet{};
  for (unsigned i = 0; i < kRayPacket; ++i) {
    packet.ray.tfar[i] = std::numeric_limits<float>::infinity();
    packet.ray.mask[i] = ~0U;
    packet.ray.id[i] = i;
    packet.hit.geomID[i] = RTC_INVALID_GEOMETRY_ID;
    packet.hit.instID[0][i] = RTC_INVALID_GEOMETRY_ID;
  }
  return packet;
}

/// A packet without rays; copied, because filling its constants costs as much as the rays.
const RTCRayHit16& empty_packet() {
  static const RTCRayHit16 kEmpty = make_empty_packet();
  return kEmpty;
}

void set_ray(RTCRay16& packet, std::size_t i, const Ray& ray) {
  packet.org_x[i] = static_cast<float>(ray.origin.x());
  packet.org_y[i] = static_cast<float>(ray.origin.y());
  packet.org_z[i] = static_cast<float>(ray.origin.z());
  packet.dir_x[i] = static_cast<float>(ray.direction.x());
  packet.dir_y[i] = static_cast<float>(ray.direction.y());
  packet.dir_z[i] = static_cast<float>(ray.direction.z());
}

}  // namespace

struct EmbreeScene::State {
  DeviceHandle device;
  SceneHandle scene;
  IsOpaque is_opaque;
  std::array<TriangleId, 2> first_of_geometry{};
  RTCIntersectContextFlags flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;

  static void filter(const RTCFilterFunctionNArguments* arguments) {
    const auto& state = *static_cast<const State*>(arguments->geometryUserPtr);
    const auto& context = *reinterpret_cast<const Context*>(arguments->context);
    for (unsigned i = 0; i < arguments->N; ++i) {
      if (arguments->valid[i] == 0) continue;
      const unsigned ray = RTCRayN_id(arguments->ray, arguments->N, i);
      const TriangleId triangle =
          state.first_of_geometry[1] + RTCHitN_primID(arguments->hit, arguments->N, i);
      if (!state.is_opaque(context.rays[ray], triangle)) arguments->valid[i] = 0;
    }
  }

  void trace(std::span<const Ray> rays, RTCRayHit16& packet) const {
    alignas(64) std::array<int, kRayPacket> valid{};
    for (std::size_t i = 0; i < rays.size(); ++i) {
      set_ray(packet.ray, i, rays[i]);
      valid[i] = -1;
    }
    Context context(rays.data(), flags);
    rtcIntersect16(valid.data(), scene.get(), &context.embree, &packet);
  }

  [[nodiscard]] TriangleId hit(const RTCRayHit16& packet, std::size_t i) const {
    const unsigned geometry = packet.hit.geomID[i];
    return geometry == RTC_INVALID_GEOMETRY_ID ? kNothing
                                               : first_of_geometry[geometry] + packet.hit.primID[i];
  }
};

EmbreeScene::EmbreeScene(const TriangleRun& opaque, const TriangleRun& cut_out, IsOpaque is_opaque)
    : state_(std::make_unique<State>()) {
  const std::size_t count = opaque.corners.size() + cut_out.corners.size();
  SACCADE_CHECK(count < kNothing / 3);
  state_->device.reset(rtcNewDevice(kDeviceOptions));
  SACCADE_CHECK(state_->device != nullptr);
  state_->scene.reset(rtcNewScene(state_->device.get()));
  state_->is_opaque = std::move(is_opaque);
  state_->first_of_geometry = {opaque.first, cut_out.first};
  if (count > kCoherentTriangles) state_->flags = RTC_INTERSECT_CONTEXT_FLAG_INCOHERENT;
  RTCScene scene = state_->scene.get();
  add_triangles(state_->device.get(), scene, opaque.corners, 0, nullptr, nullptr);
  add_triangles(state_->device.get(), scene, cut_out.corners, 1, State::filter, state_.get());
  rtcSetSceneFlags(scene, RTC_SCENE_FLAG_ROBUST);
  rtcSetSceneBuildQuality(scene, RTC_BUILD_QUALITY_HIGH);
  // One thread builds the tree, so that it is the same on every machine.
  tbb::task_arena(1).execute([scene] { rtcCommitScene(scene); });
  SACCADE_CHECK(rtcGetDeviceError(state_->device.get()) == RTC_ERROR_NONE);
}

EmbreeScene::~EmbreeScene() = default;
EmbreeScene::EmbreeScene(EmbreeScene&&) noexcept = default;
EmbreeScene& EmbreeScene::operator=(EmbreeScene&&) noexcept = default;

void EmbreeScene::nearest(std::span<const Ray> rays, std::span<TriangleId> triangles) const {
  SACCADE_CHECK(rays.size() <= kRayPacket && rays.size() == triangles.size());
  if (rays.empty()) return;
  alignas(64) RTCRayHit16 packet = empty_packet();
  state_->trace(rays, packet);
  for (std::size_t i = 0; i < rays.size(); ++i) triangles[i] = state_->hit(packet, i);
}

void EmbreeScene::nearer(std::span<const Ray> rays, std::span<TriangleId> triangles,
                         std::span<float> distances) const {
  SACCADE_CHECK(rays.size() <= kRayPacket && rays.size() == triangles.size() &&
                rays.size() == distances.size());
  if (rays.empty()) return;
  alignas(64) RTCRayHit16 packet = empty_packet();
  std::copy(distances.begin(), distances.end(), packet.ray.tfar);
  state_->trace(rays, packet);
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const TriangleId triangle = state_->hit(packet, i);
    if (triangle == kNothing) continue;
    triangles[i] = triangle;
    distances[i] = packet.ray.tfar[i];
  }
}

void EmbreeScene::find_blocked(std::span<const Ray> rays, std::span<const float> distances,
                               std::span<bool> blocked) const {
  SACCADE_CHECK(rays.size() <= kRayPacket && distances.size() == rays.size() &&
                blocked.size() == rays.size());
  if (rays.empty()) return;
  alignas(64) RTCRay16 packet = empty_packet().ray;
  alignas(64) std::array<int, kRayPacket> valid{};
  for (std::size_t i = 0; i < rays.size(); ++i) {
    if (blocked[i]) continue;
    set_ray(packet, i, rays[i]);
    packet.tfar[i] = distances[i];
    valid[i] = -1;
  }
  Context context(rays.data(), state_->flags);
  rtcOccluded16(valid.data(), state_->scene.get(), &context.embree, &packet);
  for (std::size_t i = 0; i < rays.size(); ++i)
    if (valid[i] != 0) blocked[i] = packet.tfar[i] < 0;
}

}  // namespace saccade
