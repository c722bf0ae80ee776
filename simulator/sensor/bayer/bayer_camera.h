#pragma once

#include <algorithm>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/error.h"
#include "core/random.h"
#include "simulator/sensor/adaptive/audit.h"
#include "simulator/sensor/bayer/bayer_pattern.h"
#include "simulator/sensor/event_delivery.h"
#include "simulator/sensor/event_options.h"
#include "simulator/sensor/event_tile.h"

namespace saccade {

/// An event camera behind Bayer's colour filter: four `Camera`s (EventCamera, AdaptiveCamera or
/// FrameCamera), one for each part of the pattern in the light of its colour, whose events go
/// through one latency and readout.
template <class Camera>
class BayerCamera {
 public:
  /// As EventCamera has it.
  BayerCamera(const ColourScenes& scenes, const Spline& world_from_camera,
              const PinholeCamera& camera, const EventOptions& options, std::uint64_t seed = 1)
      : seed_(seed), delivery_(options, camera, seed) {
    for (std::size_t k = 0; k < kBayerParts.size(); ++k)
      cameras_.push_back(std::make_unique<Camera>(scenes.of(kBayerParts[k].channel),
                                                  world_from_camera, kBayerParts[k].of(camera),
                                                  part_options(options), part_seed(k)));
  }

  using Sink = EventDelivery::Sink;

  /// Records from time 0, or from where a resumed camera was, to `duration_s` > 0. Call once.
  void record(double duration_s, const Sink& sink) {
    while (reached_s() < duration_s) step(duration_s, sink);
  }
  /// The slices of record() up to which the slowest part is not recorded yet.
  void step(double duration_s, const Sink& sink) {
    const double before_s = reached_s();
    for (std::size_t k = 0; k < cameras_.size(); ++k)
      if (cameras_[k]->reached_s() == before_s) step_part(k, duration_s);
    const double now_s = reached_s();
    delivery_.deliver(now_s, now_s == duration_s, sink);
  }
  /// Of the slowest part.
  [[nodiscard]] double reached_s() const {
    double slowest_s = cameras_.front()->reached_s();
    for (const auto& camera : cameras_) slowest_s = std::min(slowest_s, camera->reached_s());
    return slowest_s;
  }

  [[nodiscard]] std::string state() const {
    StateWriter state;
    for (const auto& camera : cameras_) state.text(camera->state());
    delivery_.save(state);
    return state.bytes();
  }

  /// Before record(); throws InputError where the state does not fit.
  void resume(std::string_view bytes) {
    StateReader state(bytes);
    for (const auto& camera : cameras_) camera->resume(state.text());
    delivery_.load(state);
    if (!state.at_end())
      throw InputError("saved state", "is too long; start the simulation afresh");
  }

  [[nodiscard]] EventStatistics statistics() const {
    EventStatistics total;
    for (const auto& camera : cameras_) total.add(camera->statistics());
    total.lost = delivery_.lost();
    return total;
  }

  [[nodiscard]] AuditResult audit() const requires requires(const Camera& camera) {
    camera.audited_counts();
  }
  {
    std::vector<AuditedCounts> all;
    for (const auto& camera : cameras_) {
      const std::vector<AuditedCounts> counts = camera->audited_counts();
      all.insert(all.end(), counts.begin(), counts.end());
    }
    return audit_result(all, seed_);
  }

 private:
  /// A step of the image is one of half a pixel of a part. What is behind the pixels is shared.
  static EventOptions part_options(const EventOptions& options) {
    EventOptions part = options;
    part.pixel_side = kBayerPixelSide;
    part.max_step_px *= kBayerPixelSide;
    part.frames_lambda_px *= kBayerPixelSide;
    part.noise.latency = {};
    part.noise.readout = {};
    return part;
  }

  /// Of its pixels' imperfections.
  [[nodiscard]] std::uint64_t part_seed(std::size_t part) const {
    constexpr std::uint64_t kStream = 0x4241594552ULL;  // any constant
    const auto bits = Random(seed_).bits(kStream, part);
    return (std::uint64_t{bits[0]} << 32) | bits[1];
  }

  void step_part(std::size_t k, double duration_s) {
    const BayerPart& part = kBayerParts[k];
    cameras_[k]->step(duration_s, [&](std::span<const SensedEvent> events, double) {
      for (SensedEvent event : events) {
        event.x = static_cast<std::uint16_t>(part.x0 + 2 * event.x);
        event.y = static_cast<std::uint16_t>(part.y0 + 2 * event.y);
        delivery_.pending().push_back(event);
      }
    });
  }

  std::uint64_t seed_;
  std::vector<std::unique_ptr<Camera>> cameras_;
  EventDelivery delivery_;
};

}  // namespace saccade
