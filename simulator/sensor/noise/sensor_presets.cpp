#include "simulator/sensor/noise/sensor_presets.h"

#include "core/check.h"

namespace saccade {
namespace {

SensorPreset davis240c() {
  SensorPreset preset;
  preset.contrast = {0.2, 0.2};               // estimate for default biases; v2e's default
  preset.noise.mismatch.sigma = 0.175;        // 3.5 % contrast (Brandli et al. 2014) of 0.2
  preset.noise.refractory.period_us = 500;    // v2e's default
  preset.noise.leak.rate_hz = 0.1;            // v2e's default, after Nozaki and Delbruck 2017
  preset.noise.leak.sigma = 0.2;              // estimate; v2e: 0.1 decades between pixels
  preset.noise.shot.rate_hz = 0.1;            // estimate, between v2e's bright and noisy settings
  preset.noise.bandwidth.cutoff_hz = 3000;    // estimate for 1 klux (Lichtsteiner et al. 2008)
  preset.noise.bandwidth.order = 2;           // photoreceptor and source follower
  preset.noise.hot.fraction = 1e-4;           // estimate: four pixels of the sensor
  preset.noise.hot.rate_hz = 100;             // estimate
  preset.noise.latency.mean_us = 3;           // least latency (Brandli et al. 2014)
  preset.noise.latency.jitter_us = 1;         // estimate
  preset.noise.readout.rate_hz = 12e6;        // Brandli et al. 2014
  preset.noise.readout.rows = true;           // row request, then the columns of the row
  preset.noise.readout.capacity = 240 * 180;  // every pixel holds its own request
  return preset;
}

SensorPreset dvxplorer() {
  SensorPreset preset;
  preset.contrast = {0.243, 0.243};         // ln 1.275: all pixels respond (iniVation's data sheet)
  preset.noise.mismatch.sigma = 0.2;        // estimate: half of the pixels respond at 13 %
  preset.noise.refractory.period_us = 200;  // least interval of the sequential readout (data sheet)
  preset.noise.leak.rate_hz = 0.05;         // estimate
  preset.noise.leak.sigma = 0.2;            // estimate
  preset.noise.shot.rate_hz = 0.1;          // estimate
  preset.noise.bandwidth.cutoff_hz = 1000;  // estimate from the latency below 1 ms (data sheet)
  preset.noise.bandwidth.order = 1;
  preset.noise.hot.fraction = 1e-5;      // estimate: three pixels of the sensor
  preset.noise.hot.rate_hz = 100;        // estimate
  preset.noise.latency.mean_us = 50;     // estimate
  preset.noise.latency.jitter_us = 20;   // estimate
  preset.noise.readout.rate_hz = 165e6;  // data sheet
  preset.noise.readout.rows = true;      // group readout (Suh et al., ISCAS 2020), there by column
  preset.noise.readout.capacity = 640 * 480;
  return preset;
}

}  // namespace

SensorPreset sensor_preset(SensorModel sensor) {
  switch (sensor) {
    case SensorModel::kIdeal:
      return {};
    case SensorModel::kDavis240c:
      return davis240c();
    case SensorModel::kDvxplorer:
      return dvxplorer();
  }
  SACCADE_CHECK(false);
}

}  // namespace saccade
