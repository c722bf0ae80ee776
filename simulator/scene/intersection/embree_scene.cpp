#include "simulator/scene/intersection/embree_scene.h"

#include <tbb/task_arena.h>

#include <algorithm>
#include <limits>
#include <type_traits>
#include <utility>

#include "core/check.h"
#include "simulator/scene/intersection/embree_api.h"

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

/// A query with the rays in double precision, for the cutout test.
struct RayQuery : embree::Query {
  const Ray* rays;

  RayQuery(const Ray* all_rays, embree::Coherence coherence) : Query(coherence), rays(all_rays) {}
};

/// Hands a geometry that is complete to the scene. `filter`: nullptr, or judges each hit, with
/// `user`.
void attach(RTCScene scene, RTCGeometry geometry, unsigned geometry_id, RTCFilterFunctionN filter,
            void* user) {
  if (filter != nullptr) {
    rtcSetGeometryUserData(geometry, user);
    rtcSetGeometryIntersectFilterFunction(geometry, filter);
    rtcSetGeometryOccludedFilterFunction(geometry, filter);
  }
  rtcCommitGeometry(geometry);
  rtcAttachGeometryByID(scene, geometry, geometry_id);
  rtcReleaseGeometry(geometry);
}

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
  attach(scene, geometry, geometry_id, filter, user);
}

/// Poses of one geometry, which is as many as Embree takes, and so the poses from one piece of an
/// animation to the next, which shares its first pose with the last of the former.
constexpr std::size_t kPiecePoses = RTC_MAX_TIME_STEP_COUNT;
constexpr std::size_t kPieceSteps = kPiecePoses - 1;

/// `piece` of an animation. The vertices stay where they are.
void add_animated_triangles(RTCDevice device, RTCScene scene, const VertexAnimation& animation,
                            std::size_t piece, std::span<const CornerIndices> corners,
                            unsigned geometry_id, RTCFilterFunctionN filter, void* user) {
  if (corners.empty()) return;
  const std::size_t first = piece * kPieceSteps;
  const std::size_t poses = std::min(kPiecePoses, animation.step_count() - first);
  RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
  rtcSetGeometryTimeStepCount(geometry, static_cast<unsigned>(poses));
  for (unsigned k = 0; k < poses; ++k)
    rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, k, RTC_FORMAT_FLOAT3,
                               animation.vertices(first + k).data(), 0, 3 * sizeof(float),
                               animation.vertex_count());
  rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, corners.data(),
                             0, sizeof(CornerIndices), corners.size());
  attach(scene, geometry, geometry_id, filter, user);
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
  std::vector<SceneHandle> scenes;  ///< one, or one per piece of the animation
  IsOpaque is_opaque;
  std::array<TriangleId, 2> first_of_geometry{};
  embree::Coherence coherence = embree::Coherence::kCoherent;
  std::shared_ptr<const VertexAnimation> animation;
  std::array<std::vector<CornerIndices>, 2> corners;  ///< of an animation's geometries

  State(const std::array<TriangleId, 2>& first, IsOpaque opacity)
      : device(rtcNewDevice(kDeviceOptions)),
        is_opaque(std::move(opacity)),
        first_of_geometry(first) {
    SACCADE_CHECK(device != nullptr);
  }

  RTCScene add_scene() {
    scenes.emplace_back(rtcNewScene(device.get()));
    rtcSetSceneFlags(scenes.back().get(), RTC_SCENE_FLAG_ROBUST);
    rtcSetSceneBuildQuality(scenes.back().get(), RTC_BUILD_QUALITY_HIGH);
    return scenes.back().get();
  }

  void commit(RTCScene scene) const {
    // One thread builds the tree, so that it is the same on every machine.
    tbb::task_arena(1).execute([scene] { rtcCommitScene(scene); });
    SACCADE_CHECK(rtcGetDeviceError(device.get()) == RTC_ERROR_NONE);
  }

  static void filter(const RTCFilterFunctionNArguments* arguments) {
    const auto& state = *static_cast<const State*>(arguments->geometryUserPtr);
    const auto& query = static_cast<const RayQuery&>(embree::query_of(*arguments));
    for (unsigned i = 0; i < arguments->N; ++i) {
      if (arguments->valid[i] == 0) continue;
      const unsigned ray = RTCRayN_id(arguments->ray, arguments->N, i);
      const TriangleId triangle =
          state.first_of_geometry[1] + RTCHitN_primID(arguments->hit, arguments->N, i);
      if (!state.is_opaque(query.rays[ray], triangle)) arguments->valid[i] = 0;
    }
  }

  /// trace(scene, valid) for the rays of a packet that are valid: once, or where they see different
  /// pieces of the animation, once for each of these. Sets their times.
  template <class Trace>
  void for_pieces(std::span<const Ray> rays, RTCRay16& packet,
                  const std::array<int, kRayPacket>& valid, const Trace& trace) const {
    if (!animation) return trace(scenes.front().get(), valid);
    std::array<std::size_t, kRayPacket> pieces{};
    for (std::size_t i = 0; i < rays.size(); ++i) {
      const VertexAnimation::Moment moment = animation->at(rays[i].time_s);
      pieces[i] = moment.step / kPieceSteps;
      const std::size_t first = pieces[i] * kPieceSteps;
      const std::size_t steps = std::min(kPieceSteps, animation->step_count() - 1 - first);
      packet.time[i] =
          static_cast<float>((static_cast<double>(moment.step - first) + moment.fraction) /
                             static_cast<double>(steps));
    }
    alignas(64) std::array<int, kRayPacket> open = valid;
    for (std::size_t i = 0; i < rays.size(); ++i) {
      if (open[i] == 0) continue;
      alignas(64) std::array<int, kRayPacket> now{};
      for (std::size_t k = i; k < rays.size(); ++k)
        if (open[k] != 0 && pieces[k] == pieces[i]) {
          now[k] = -1;
          open[k] = 0;
        }
      trace(scenes[pieces[i]].get(), now);
    }
  }

  void trace(std::span<const Ray> rays, RTCRayHit16& packet) const {
    alignas(64) std::array<int, kRayPacket> valid{};
    for (std::size_t i = 0; i < rays.size(); ++i) {
      set_ray(packet.ray, i, rays[i]);
      valid[i] = -1;
    }
    RayQuery query(rays.data(), coherence);
    for_pieces(rays, packet.ray, valid,
               [&](RTCScene scene, const std::array<int, kRayPacket>& some) {
                 embree::intersect16(some.data(), scene, query, packet);
               });
  }

  [[nodiscard]] TriangleId hit(const RTCRayHit16& packet, std::size_t i) const {
    const unsigned geometry = packet.hit.geomID[i];
    return geometry == RTC_INVALID_GEOMETRY_ID ? kNothing
                                               : first_of_geometry[geometry] + packet.hit.primID[i];
  }
};

EmbreeScene::EmbreeScene(const TriangleRun& opaque, const TriangleRun& cut_out, IsOpaque is_opaque)
    : state_(
          std::make_unique<State>(std::array{opaque.first, cut_out.first}, std::move(is_opaque))) {
  const std::size_t count = opaque.corners.size() + cut_out.corners.size();
  SACCADE_CHECK(count < kNothing / 3);
  if (count > kCoherentTriangles) state_->coherence = embree::Coherence::kIncoherent;
  RTCScene scene = state_->add_scene();
  add_triangles(state_->device.get(), scene, opaque.corners, 0, nullptr, nullptr);
  add_triangles(state_->device.get(), scene, cut_out.corners, 1, State::filter, state_.get());
  state_->commit(scene);
}

EmbreeScene::EmbreeScene(std::shared_ptr<const VertexAnimation> animation,
                         const AnimatedTriangleRun& opaque, const AnimatedTriangleRun& cut_out,
                         IsOpaque is_opaque)
    : state_(
          std::make_unique<State>(std::array{opaque.first, cut_out.first}, std::move(is_opaque))) {
  SACCADE_CHECK(animation != nullptr);
  state_->animation = std::move(animation);
  state_->coherence = embree::Coherence::kIncoherent;
  state_->corners = {std::vector(opaque.corners.begin(), opaque.corners.end()),
                     std::vector(cut_out.corners.begin(), cut_out.corners.end())};
  RTCDevice device = state_->device.get();
  const std::size_t steps = state_->animation->step_count() - 1;
  for (std::size_t piece = 0; piece * kPieceSteps < steps; ++piece) {
    RTCScene scene = state_->add_scene();
    add_animated_triangles(device, scene, *state_->animation, piece, state_->corners[0], 0, nullptr,
                           nullptr);
    add_animated_triangles(device, scene, *state_->animation, piece, state_->corners[1], 1,
                           State::filter, state_.get());
    state_->commit(scene);
  }
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
  RayQuery query(rays.data(), state_->coherence);
  state_->for_pieces(rays, packet, valid,
                     [&](RTCScene scene, const std::array<int, kRayPacket>& some) {
                       embree::occluded16(some.data(), scene, query, packet);
                     });
  for (std::size_t i = 0; i < rays.size(); ++i)
    if (valid[i] != 0) blocked[i] = packet.tfar[i] < 0;
}

}  // namespace saccade
