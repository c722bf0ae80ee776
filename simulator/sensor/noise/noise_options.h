#pragma once

#include "simulator/sensor/noise/event_bus.h"
#include "simulator/sensor/noise/event_delay.h"
#include "simulator/sensor/noise/leak.h"
#include "simulator/sensor/noise/mismatch.h"
#include "simulator/sensor/noise/photoreceptor.h"
#include "simulator/sensor/noise/refractory.h"
#include "simulator/sensor/noise/spontaneous_events.h"

namespace saccade {

/// The imperfections of an event sensor (section `events.noise`), all off. Each model's file has
/// its options; noise_models() has one row for each member.
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
void describe(config::Fields& fields, NoiseOptions& options);

}  // namespace saccade
