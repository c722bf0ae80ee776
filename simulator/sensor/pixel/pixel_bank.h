#pragma once

#include <cmath>
#include <cstdint>
#include <vector>

#include "simulator/sensor/event_options.h"
#include "simulator/sensor/noise/state_bytes.h"
#include "simulator/sensor/pixel/crossing.h"
#include "simulator/sensor/pixel/pixel_noise.h"
#include "simulator/sensor/pixel/pixel_sensor.h"
#include "simulator/sensor/pixel/pixel_traits.h"
#include "simulator/sensor/pixel/sensed_event.h"
#include "simulator/sensor/rays/pixel_rays.h"

namespace saccade {

/// The event pixels of a tile, whatever their signals come from: what distinguishes them, what they
/// remember, and the events that they fire.
class PixelBank {
 public:
  /// `options` and `noise`, made of them and `seed`, outlive the bank.
  PixelBank(const EventOptions& options, const PixelNoise& noise, std::uint64_t seed,
            const Tile& tile);

  [[nodiscard]] std::size_t size() const { return pixels_.size(); }

  /// Pixel `i` has seen `log_intensity` for long at `t_s`.
  void start(std::size_t i, double log_intensity, double t_s);

  /// Senses an interval of the signal of pixel `i`, which follows on the one before. Returns the
  /// widest final bracket around a crossing [s].
  template <class Signal>
  double sense(std::size_t i, const Signal& signal, const typename Signal::Sample& from,
               const typename Signal::Sample& to);

  /// Whether sense() uses more of a signal than where it crosses a threshold.
  [[nodiscard]] bool is_noisy() const { return !noisy_.empty(); }
  /// Whether only a crossing could make pixel `i` fire between two times.
  [[nodiscard]] bool is_idle(std::size_t i, double from_s, double to_s) const {
    return noisy_.empty() || (!noise_.filter.on() && noisy_[i].is_idle(from_s, to_s));
  }
  /// When the refractory period of pixel `i` ends; before all times where none is under way.
  [[nodiscard]] double refractory_until_s(std::size_t i) const {
    return noisy_.empty() ? NoisyState::kNotRefractory : noisy_[i].refractory_until_s;
  }
  /// What pixel `i` fires at.
  [[nodiscard]] const Thresholds& thresholds(std::size_t i) const { return pixels_[i].thresholds; }

  /// Moves out the events since the last call, in the order in which they were sensed; times
  /// rounded to the unit.
  void take_events(SensedEvents& out) {
    out.insert(out.end(), events_.begin(), events_.end());
    events_.clear();
  }

  /// All that later events depend on; those not yet taken are left out.
  void save(StateWriter& state) const;
  /// Of a bank of the same pixels, in place of start().
  void load(StateReader& state);

 private:
  struct Pixel {
    PixelTraits traits;
    PixelState state;
    Thresholds thresholds;
  };

  void update_thresholds(Pixel& pixel) const;
  void record(const PixelTraits& pixel, double t_s, int polarity, EventOrigin origin,
              double log_intensity) {
    const TimeNs unit_ns = options_.timestamp_unit_ns();
    const auto units = static_cast<TimeNs>(std::llround(t_s * 1e9 / static_cast<double>(unit_ns)));
    events_.push_back({units * unit_ns, pixel.x, pixel.y, static_cast<std::int8_t>(polarity),
                       origin, static_cast<float>(log_intensity)});
  }

  const EventOptions& options_;
  const PixelNoise& noise_;
  std::vector<Pixel> pixels_;
  std::vector<NoisyState> noisy_;  ///< one per pixel, or none
  SensedEvents events_;
};

template <class Signal>
double PixelBank::sense(std::size_t i, const Signal& signal, const typename Signal::Sample& from,
                        const typename Signal::Sample& to) {
  Pixel& pixel = pixels_[i];
  const auto emit = [&](double t_s, int polarity, EventOrigin origin, double log_intensity) {
    record(pixel.traits, t_s, polarity, origin, log_intensity);
  };
  PixelSensor sensor(signal, pixel.traits, options_.log_eps, pixel.state, pixel.thresholds, emit);
  if (noisy_.empty()) return sensor.sense(from, to);
  if (noise_.filter.on()) return sensor.sense_filtered(from, to, noise_, noisy_[i]);
  return sensor.sense(from, to, noise_, noisy_[i]);
}

}  // namespace saccade
