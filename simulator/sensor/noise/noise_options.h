#pragma once

#include <cstdint>
#include <span>
#include <string_view>

#include "core/config/fields.h"

namespace saccade {

/// Contrast thresholds that differ from pixel to pixel (fixed-pattern noise):
///   C_p = C max(kLeastContrast, 1 + sigma z),   z ~ N(0, 1), one draw per pixel and polarity
/// Measured so by Lichtsteiner et al. (JSSC 43(2), 2008) and Brandli et al. (JSSC 49(10),
/// 2014); Gaussian as in v2e (Hu et al., CVPRW 2021).
struct MismatchOptions {
  double sigma = 0;  ///< standard deviation as a share of the nominal threshold

  [[nodiscard]] bool on() const { return sigma > 0; }
};

/// After an event the pixel is blind for `period_us`; at the end the reference is the signal of
/// that time (the reset of the differencing amplifier; Lichtsteiner et al. 2008). A ramp of slope s
/// fires at 1 / (T + C / s).
struct RefractoryOptions {
  double period_us = 0;

  [[nodiscard]] bool on() const { return period_us > 0; }
};

/// The reset switch leaks, so the reference falls at C_on rate and a static scene gives ON events
/// (Nozaki and Delbruck, IEEE T-ED 64(8), 2017):
///   rate_p = rate_hz max(0, 1 + sigma z),   z ~ N(0, 1), one draw per pixel
struct LeakOptions {
  double rate_hz = 0;  ///< mean rate of leak events of a pixel before a static scene
  double sigma = 0;    ///< standard deviation of a pixel's rate as a share of rate_hz

  [[nodiscard]] bool on() const { return rate_hz > 0; }
};

/// Shot noise: a Poisson process per pixel, ON and OFF equally likely, whose rate falls from
/// rate_hz in the dark linearly with the radiance to bright_share of it (v2e, Hu et al. 2021;
/// measured by Graca et al., "Shining light on the DVS pixel", 2023):
///   rate(I) = rate_hz (1 - (1 - bright_share) min(1, I / bright_radiance))
struct ShotOptions {
  double rate_hz = 0;          ///< ON and OFF together, at I = 0
  double bright_share = 0.25;  ///< of the rate, that remains at bright_radiance and above
  double bright_radiance = 1;

  [[nodiscard]] bool on() const { return rate_hz > 0; }
};

/// The photoreceptor as a low pass of the log intensity with one pole or two equal ones, whose
/// cutoff grows with the photocurrent (Lichtsteiner et al. 2008, Hu et al. 2021):
///   f_c(I) = min(max_cutoff_hz, cutoff_hz (I + dark_radiance) / (bright_radiance + dark_radiance))
struct BandwidthOptions {
  double cutoff_hz = 0;  ///< at bright_radiance; 0: no filter
  int order = 1;         ///< poles: 1 or 2
  double bright_radiance = 1;
  double dark_radiance = 0.08;  ///< stands for the dark current: keeps f_c > 0 at I = 0
  double max_cutoff_hz = 1e5;   ///< of the stages behind the photodiode

  [[nodiscard]] bool on() const { return cutoff_hz > 0; }
};

/// Pixels whose leaking junctions fire by themselves: a Poisson process of ON events per hot pixel,
///   rate_p = rate_hz exp(sigma z),   z ~ N(0, 1), one draw per pixel
/// The heavy tail is what noise histograms of real sensors show (Joubert et al., Frontiers in
/// Neuroscience 15, 2021).
struct HotOptions {
  double fraction = 0;   ///< share of the pixels that are hot
  double rate_hz = 100;  ///< median over the hot pixels
  double sigma = 0.5;    ///< of the natural logarithm of the rate

  [[nodiscard]] bool on() const { return fraction > 0 && rate_hz > 0; }
};

/// Time from the crossing to the request at the bus:
///   latency = max(0, mean_us + intensity_us (1 + dark_radiance) / (I + dark_radiance)
///                    + jitter_us z),   z ~ N(0, 1) cut at +-4
/// Reciprocal in the radiance as Lichtsteiner et al. 2008 measured. The bandwidth model brings a
/// latency of its own; state only the rest here when both are on.
struct LatencyOptions {
  double mean_us = 0;
  double intensity_us = 0;  ///< added at radiance 1
  double dark_radiance = 0.08;
  double jitter_us = 0;  ///< standard deviation

  [[nodiscard]] bool on() const { return mean_us > 0 || intensity_us > 0 || jitter_us > 0; }
};

/// A bus that serves `rate_hz` events per second in the order of their requests, or row by row: the
/// row that has waited longest sends all its events under one time stamp (Boahen's address-event
/// readout; Brandli et al. 2014). An event that meets a full queue is lost and counted.
struct ReadoutOptions {
  double rate_hz = 0;  ///< 0: no limit
  bool rows = false;
  std::int64_t capacity = 0;  ///< events that can wait; 0: no limit

  [[nodiscard]] bool on() const { return rate_hz > 0; }
};

/// The imperfections of an event sensor (section `events.noise`), all off.
struct NoiseOptions {
  MismatchOptions mismatch;
  RefractoryOptions refractory;
  LeakOptions leak;
  ShotOptions shot;
  BandwidthOptions bandwidth;
  HotOptions hot;
  LatencyOptions latency;
  ReadoutOptions readout;

  [[nodiscard]] bool any() const;
};

/// One row of the table of models: its section in the configuration and whether it does anything.
struct NoiseModel {
  std::string_view name;
  std::string_view help;
  void (*describe)(config::Fields& fields, NoiseOptions& options);
  bool (*is_on)(const NoiseOptions& options);
};

/// All models; a new one is one more row.
[[nodiscard]] std::span<const NoiseModel> noise_models();

void describe(config::Fields& fields, NoiseOptions& options);

}  // namespace saccade
