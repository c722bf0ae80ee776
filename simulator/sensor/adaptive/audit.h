#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "core/camera.h"
#include "core/spline/spline.h"
#include "simulator/scene/scene.h"
#include "simulator/sensor/adaptive/adaptive_tile.h"
#include "simulator/sensor/adaptive/audit_result.h"
#include "simulator/sensor/adaptive/event_matcher.h"
#include "simulator/sensor/event_camera.h"
#include "simulator/sensor/event_options.h"
#include "simulator/sensor/rays/pixel_rays.h"

namespace saccade {

/// An audited tile: its pixels, and how their events match.
struct AuditedCounts {
  std::size_t pixels = 0;
  MatchCounts counts;
};

/// The figures of some audited tiles, with intervals from bootstrap samples of them.
[[nodiscard]] AuditResult audit_result(std::span<const AuditedCounts> tiles, std::uint64_t seed);

/// What the events of an audited camera are compared with.
enum class AuditReference {
  kExact,  ///< those of an EventCamera
  kDense,  ///< those of the same sampling with steps and tolerances many times finer
};

/// Animated scenes have no exact events.
[[nodiscard]] AuditReference audit_reference(const Scene& scene);

/// Records a random share of a camera's tiles with a reference, beside another camera that records
/// all of them, and compares the events of both as they leave the pixels, before latency and
/// readout. The tiles are drawn by the seed, one from each of equal parts of the image.
class Audit {
 public:
  /// The arguments of the audited camera; nothing is audited where audit_fraction is 0.
  Audit(const Scene& scene, const Spline& world_from_camera, const PinholeCamera& camera,
        const EventOptions& options, std::uint64_t seed);

  /// Events of a tile of the audited camera, in the order in which they were found.
  void add(std::size_t tile, std::span<const SensedEvent> events);
  /// Records a slice densely where that is the reference. `around_px_s`: of a tile, as
  /// AdaptiveTile::advance() has it.
  void sense(const AdaptiveSlice& slice, const std::function<double(std::size_t)>& around_px_s);
  /// All events of the audited camera up to `t_s` have been added: compares up to there, with an
  /// exact reference after it is recorded.
  void advance(double t_s, double duration_s);

  /// Of a whole recording.
  [[nodiscard]] std::vector<AuditedCounts> counts() const;
  [[nodiscard]] AuditResult result() const { return audit_result(counts(), seed_); }

  void save(StateWriter& state) const;
  void load(StateReader& state);

 private:
  struct AuditedTile {
    Tile tile;
    std::vector<EventMatcher> matchers;  ///< two for each pixel
    MatchCounts counts;

    EventMatcher& matcher(const SensedEvent& event);
  };

  [[nodiscard]] AuditedTile* audited(std::size_t tile);

  PixelRays rays_;
  std::uint64_t seed_;
  std::vector<std::size_t> index_;  ///< of the audited tiles, in order
  std::vector<AuditedTile> tiles_;  ///< these
  std::optional<EventCamera> exact_;
  EventOptions dense_options_;
  PixelNoise noise_;
  std::vector<std::unique_ptr<AdaptiveTile>> dense_;  ///< in place of `exact_`
  bool has_started_ = false;                          ///< these
};

}  // namespace saccade
