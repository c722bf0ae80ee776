#include "simulator/event_source.h"

#include <utility>

#include "core/check.h"
#include "core/error.h"
#include "simulator/sensor/adaptive/adaptive_camera.h"
#include "simulator/sensor/bayer/bayer_camera.h"
#include "simulator/sensor/event_camera.h"
#include "simulator/sensor/frame_camera.h"

namespace saccade {
namespace {

template <class Camera>
class SourceOf final : public EventSource {
 public:
  template <class... Arguments>
  explicit SourceOf(Arguments&&... arguments) : camera_(std::forward<Arguments>(arguments)...) {}

  void record(double duration_s, const Sink& sink) override { camera_.record(duration_s, sink); }
  void step(double duration_s, const Sink& sink) override { camera_.step(duration_s, sink); }
  [[nodiscard]] double reached_s() const override { return camera_.reached_s(); }
  [[nodiscard]] std::string state() const override { return camera_.state(); }
  void resume(std::string_view state) override { camera_.resume(state); }
  [[nodiscard]] EventStatistics statistics() const override { return camera_.statistics(); }
  [[nodiscard]] AuditResult audit() const override {
    if constexpr (requires { camera_.audit(); }) return camera_.audit();
    return {};
  }

 private:
  Camera camera_;
};

/// From so many triangles on the exact search for what may come into view costs more than the rays
/// that it saves.
constexpr std::size_t kManyTriangles = 10'000;

}  // namespace

Sampling chosen_sampling(Sampling sampling, const Scene& scene) {
  if (sampling == Sampling::kExact && scene.is_animated())
    throw InputError("events.sampling",
                     "exact cannot be combined with an animated mesh: its proofs hold for rigid "
                     "motion; state adaptive, auto or frames");
  if (sampling != Sampling::kAuto) return sampling;
  if (scene.is_animated()) return Sampling::kAdaptive;
  return scene.is_lit() && scene.triangle_count() >= kManyTriangles ? Sampling::kAdaptive
                                                                    : Sampling::kExact;
}

std::string sampling_reason(Sampling sampling, const Scene& scene) {
  if (sampling != Sampling::kAuto) return "stated";
  if (scene.is_animated()) return "animated meshes";
  return chosen_sampling(sampling, scene) == Sampling::kAdaptive ? "lights and many triangles"
                                                                 : "rigid motion";
}

std::unique_ptr<EventSource> make_event_source(const EventOptions& options, std::uint64_t seed,
                                               const Scene& scene, const ColourScenes* colours,
                                               const Spline& world_from_camera,
                                               const PinholeCamera& camera) {
  const auto make = [&]<class Camera>() -> std::unique_ptr<EventSource> {
    if (options.colour_filter == ColourFilter::kNone)
      return std::make_unique<SourceOf<Camera>>(scene, world_from_camera, camera, options, seed);
    SACCADE_CHECK(colours != nullptr);
    return std::make_unique<SourceOf<BayerCamera<Camera>>>(*colours, world_from_camera, camera,
                                                           options, seed);
  };
  switch (chosen_sampling(options.sampling, scene)) {
    case Sampling::kFrames:
      return make.template operator()<FrameCamera>();
    case Sampling::kAdaptive:
      return make.template operator()<AdaptiveCamera>();
    default:
      return make.template operator()<EventCamera>();
  }
}

}  // namespace saccade
