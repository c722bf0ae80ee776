#pragma once

#include <algorithm>
#include <cmath>

#include "core/event.h"
#include "core/image.h"
#include "core/io/events/event_file.h"

namespace saccade {

/// How far the changes of log intensity that pixels sum up are from the truth on average over a window. What a scene
/// gains in one place it loses in another, so that what most of the sensor gains or loses is of the pixels: they miss more
/// of the falls than of the rises, or the reverse, the more the faster they fire, and the references of those that leak begin
/// below what they see. A hundredth of a log unit per pixel of motion is a slope over the whole image.
struct ChangeBias {
  /// An event that comes within this time of the one before it is quick; a later one is so in proportion. Within the shortest
  /// blind times of real sensors, so that those of longer ones are told by the proportion.
  static constexpr float kQuick_ns = 3e5F;
  /// Largest bias, as a fraction of a change: one that few quick events tell must not reverse the changes of pixels whose events
  /// are all quick.
  static constexpr float kMost = 0.5F;

  float start = 0;  ///< of what pixels see at the start above their references, mean [log units]
  float last_polarity = 0;   ///< of the last event of a pixel so far, mean over pixels and time
  float fraction = 0;        ///< by which each change is too high
  float quick_fraction = 0;  ///< and by which that of a quick event is higher still

  /// Of the change of one event [log units].
  [[nodiscard]] float of(float change, float quickness) const {
    return std::clamp(fraction + quickness * quick_fraction, -kMost, kMost) * std::abs(change);
  }
  /// From 0 to 1.
  [[nodiscard]] static float quickness(TimeNs interval_ns) {
    const auto interval = static_cast<float>(interval_ns);
    return interval <= kQuick_ns ? 1 : kQuick_ns / interval;
  }
};

/// Finds the bias of a window from the changes of all its events.
class ChangeBiasFit {
 public:
  explicit ChangeBiasFit(SensorSize size);

  /// The first event of a pixel.
  void add_first(const Event& event, float change);
  /// Another event of the pixel, `interval_ns` after one of `polarity_before`.
  void add(const Event& event, float change, TimeNs interval_ns, int polarity_before);
  /// For so long the window went on after the last event of the pixel at x, y.
  void add_rest(int x, int y, TimeNs interval_ns, int polarity);

  /// What is found is taken as far as it stands out from what parts of the sensor show by chance.
  [[nodiscard]] ChangeBias found() const;

 private:
  /// Sums over a part of the sensor.
  struct Tile {
    double pixels = 0;
    double first_change = 0, firsts = 0;  ///< of first events, and their number
    double net = 0, size = 0, quick = 0;  ///< changes, their sizes and those of quick events
    double polarity_ns = 0, time_ns = 0;  ///< time by the polarity of the last event, and all
  };
  [[nodiscard]] Tile& tile_of(int x, int y);
  /// Sum of one member over that of the other, shrunk by its chance.
  [[nodiscard]] double mean(double Tile::*sum, double Tile::*count) const;

  Image<Tile> tiles_;
};

}  // namespace saccade
