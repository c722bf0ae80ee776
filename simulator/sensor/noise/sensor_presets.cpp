#include "simulator/sensor/noise/sensor_presets.h"

#include "core/check.h"

namespace saccade {
namespace {

// Where no source is named the value is an estimate.
SensorPreset davis240c() {
  SensorPreset preset;
  NoiseOptions& noise = preset.noise;
  preset.contrast = {0.2, 0.2};      // v2e's default; depends on the bias settings
  noise.mismatch.sigma = 0.175;      // 3.5 % contrast (Brandli et al. 2014) over 0.2
  noise.refractory.period_us = 500;  // v2e's default; depends on the bias settings
  noise.leak.rate_hz = 0.1;          // v2e's noisy setting, after Nozaki and Delbruck 2017
  noise.leak.sigma = 0.2;            // v2e: 0.1 decades between pixels
  noise.shot.rate_hz = 0.1;          // v2e: 0.001 in good light, 5 in its noisy setting
  noise.bandwidth.cutoff_hz = 3000;  // some kHz in bright light (Lichtsteiner et al. 2008)
  noise.bandwidth.order = 2;         // photoreceptor and source follower
  noise.hot.fraction = 1e-4;         // four pixels of the sensor
  noise.hot.rate_hz = 100;
  noise.latency.mean_us = 3;  // the least latency (Brandli et al. 2014)
  noise.latency.jitter_us = 1;
  noise.readout.rate_hz = 12e6;        // Brandli et al. 2014
  noise.readout.rows = true;           // a row's request, then its columns
  noise.readout.capacity = 240 * 180;  // every pixel holds its own request
  return preset;
}

SensorPreset dvxplorer() {
  SensorPreset preset;
  NoiseOptions& noise = preset.noise;
  preset.contrast = {0.122, 0.122};  // ln 1.13: half of the pixels respond (data sheet)
  noise.mismatch.sigma = 0.22;       // all respond at 27.5 %: 4.5 sigma of 307 200 pixels
  noise.refractory.period_us = 200;  // temporal resolution 65 to 200 us (data sheet)
  noise.leak.rate_hz = 0.05;
  noise.leak.sigma = 0.2;
  noise.shot.rate_hz = 0.1;
  noise.bandwidth.cutoff_hz = 1000;  // latency below 1 ms (data sheet)
  noise.bandwidth.order = 1;
  noise.hot.fraction = 1e-5;  // three pixels of the sensor
  noise.hot.rate_hz = 100;
  noise.latency.mean_us = 50;
  noise.latency.jitter_us = 20;
  noise.readout.rate_hz = 165e6;  // data sheet
  noise.readout.rows = true;      // groups of pixels (Suh et al., ISCAS 2020), by column
  noise.readout.capacity = 640 * 480;
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
