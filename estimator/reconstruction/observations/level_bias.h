#pragma once

#include <algorithm>
#include <cmath>

#include "core/event.h"
#include "core/image.h"
#include "core/io/events/event_file.h"

namespace saccade {

/// How far the changes that pixels sum up are from the truth on average over a window. What a scene
/// gains in one place it loses in another, so that what most of the sensor gains or loses is of the
/// pixels: they miss more of the falls than of the rises, or the reverse, the more the faster they
/// fire, and their references begin below what they see, as those of leaking pixels do. A hundredth
/// of a log unit per pixel of motion is a slope over the whole image.
struct LevelBias {
  /// An event that comes within this time of the one before it is quick; a later one is so in
  /// proportion. What a pixel misses grows as its blind time counts more, 0.2 to 2 ms.
  static constexpr float kQuick_ns = 3e5F;

  /// Of a change: what few quick events tell is not meant for a pixel whose events are all quick.
  static constexpr float kMost = 0.5F;

  float start = 0;          ///< of what a pixel sees at the start above its reference [log units]
  float last_polarity = 0;  ///< of the last event of a pixel so far, mean over pixels and time
  float per_change = 0;     ///< share by which each change is too high
  float per_quick_change = 0;  ///< more of that, of quick events

  /// Of one change [log units].
  [[nodiscard]] float of(float change, float quickness) const {
    const float share = std::clamp(per_change + quickness * per_quick_change, -kMost, kMost);
    return share * std::abs(change);
  }
  /// From 0 to 1.
  [[nodiscard]] static float quickness(TimeNs interval_ns) {
    const auto interval = static_cast<float>(interval_ns);
    return interval <= kQuick_ns ? 1 : kQuick_ns / interval;
  }
};

/// Finds the bias of a window from the changes of all its events.
class LevelBiasFit {
 public:
  explicit LevelBiasFit(SensorSize size);

  /// The first event of a pixel.
  void add_first(const Event& event, float change);
  /// One after another event of the pixel, `interval_ns` before it and of `polarity_before`.
  void add(const Event& event, float change, TimeNs interval_ns, int polarity_before);
  /// For so long the window went on after the last event of a pixel, of this polarity.
  void add_rest(TimeNs interval_ns, int polarity);

  /// What is found is taken as far as it stands out from the changes of the scene, which parts of the
  /// sensor have in different amounts.
  [[nodiscard]] LevelBias found() const;

 private:
  /// Part of the sensor.
  struct Tile {
    double net = 0, size = 0, quick = 0;  ///< sums of changes, their sizes and those of quick ones
    double firsts = 0;                    ///< number of first events
  };
  Tile& tile_of(const Event& event);

  SensorSize size_;
  Image<Tile> tiles_;
  double first_change_ = 0, firsts_ = 0;
  double polarity_ns_ = 0, time_ns_ = 0;
};

}  // namespace saccade
