#pragma once

#include <span>

#include "core/event.h"
#include "core/io/events/event_file.h"
#include "estimator/reconstruction/contrast_thresholds.h"
#include "estimator/reconstruction/observations/change_bias.h"

namespace saccade {

/// By how much a pixel's log intensity has changed from one event of it to the next: by a threshold while it saw, and
/// by something while it was blind after the first of them, since its reference is set when that ends. A ramp of
/// slope s fires each T + C / s, so that the change is C + s T. The slope of the blind time is the mean of those before and
/// after it, each C over the time for which the pixel saw; before a pixel's first event it is not known and counts as 0.
///
/// That holds where the texture is the same before and after, and two events in a row are of one polarity. Where they are as often
/// of two, the slopes tell nothing: blind changes are weighed by the square of the correlation of successive polarities.
/// As the log intensity of an edge is steep at its dark end, which a pixel misses where it comes first, rises
/// and falls do not cancel out; they are weighed against each other so that all changes of a window do.
class LevelChanges {
 public:
  /// What is known of a pixel.
  struct Pixel {
    TimeNs t_ns = 0;   ///< of its last event
    int polarity = 0;  ///< of that; 0: none so far
    float slope = 0;   ///< before that [log units / ns]
  };

  /// `blind_s` >= 0; 0: every event is a threshold. `removes_bias`: of the changes, change_bias.h.
  LevelChanges(const ContrastThresholds& thresholds, double blind_s, bool removes_bias = false);

  /// Weighs blind changes and finds the bias by all events of a window, in order of time. Before next().
  void weigh(std::span<const Event> events, SensorSize size);

  /// From the pixel's event before this one, which becomes its last one [log units].
  [[nodiscard]] float next(const Event& event, Pixel& pixel) const {
    const bool is_first = pixel.polarity == 0;
    const TimeNs interval_ns = event.t_ns - pixel.t_ns;
    const float change = biased(event, pixel);
    return is_first ? change : change - bias_.of(change, ChangeBias::quickness(interval_ns));
  }

  [[nodiscard]] const ChangeBias& bias() const { return bias_; }

 private:
  [[nodiscard]] float threshold(const Event& event) const {
    return event.polarity > 0 ? on_ : -off_;
  }
  /// As next(), before the bias is removed.
  [[nodiscard]] float biased(const Event& event, Pixel& pixel) const {
    const float blind = blind_ns_ == 0 ? 0 : blind_change(event, pixel);
    pixel.t_ns = event.t_ns;
    pixel.polarity = event.polarity;
    return threshold(event) + (blind > 0 ? rise_weight_ : fall_weight_) * blind;
  }
  /// Time between two events for which the pixel saw [ns].
  [[nodiscard]] float seen_ns(TimeNs interval_ns) const;
  [[nodiscard]] float blind_change(const Event& event, Pixel& pixel) const;
  void weigh_blind(std::span<const Event> events, SensorSize size);
  [[nodiscard]] ChangeBias bias_of(std::span<const Event> events, SensorSize size) const;

  float on_, off_;
  float blind_ns_;
  bool removes_bias_;
  float rise_weight_ = 0, fall_weight_ = 0;
  ChangeBias bias_;
};

}  // namespace saccade
