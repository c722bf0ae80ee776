#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>

#include "core/camera.h"
#include "core/spline/spline.h"
#include "simulator/scene/scene.h"
#include "simulator/sensor/adaptive/audit_result.h"
#include "simulator/sensor/bayer/bayer_pattern.h"
#include "simulator/sensor/event_delivery.h"
#include "simulator/sensor/event_options.h"
#include "simulator/sensor/rays/ray_tracer.h"

namespace saccade {

/// What `auto` stands for in a scene: kAdaptive where a mesh is animated or lights shine on many
/// triangles, else kExact; any other sampling stands for itself. Throws InputError for kExact in an
/// animated scene.
[[nodiscard]] Sampling chosen_sampling(Sampling sampling, const Scene& scene);
/// Why it is that one, in few words.
[[nodiscard]] std::string sampling_reason(Sampling sampling, const Scene& scene);

/// An event camera of whatever sampling and colour filter: EventCamera, AdaptiveCamera or
/// FrameCamera, or one of them behind Bayer's filter, which say what the functions do.
class EventSource {
 public:
  using Sink = EventDelivery::Sink;
  virtual ~EventSource() = default;

  virtual void record(double duration_s, const Sink& sink) = 0;
  virtual void step(double duration_s, const Sink& sink) = 0;
  [[nodiscard]] virtual double reached_s() const = 0;
  [[nodiscard]] virtual std::string state() const = 0;
  virtual void resume(std::string_view state) = 0;
  [[nodiscard]] virtual EventStatistics statistics() const = 0;
  /// Without pixels where nothing is audited.
  [[nodiscard]] virtual AuditResult audit() const = 0;
};

/// The camera that `options` ask for. `colours` may be nullptr where there is no colour filter; all
/// that is passed by reference outlives the source.
[[nodiscard]] std::unique_ptr<EventSource> make_event_source(const EventOptions& options,
                                                             std::uint64_t seed, const Scene& scene,
                                                             const ColourScenes* colours,
                                                             const Spline& world_from_camera,
                                                             const PinholeCamera& camera);

}  // namespace saccade
