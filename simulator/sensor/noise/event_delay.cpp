#include "simulator/sensor/noise/event_delay.h"

#include <algorithm>
#include <cmath>

#include "core/config/fields.h"
#include "simulator/sensor/noise/pixel_random.h"

namespace saccade {
namespace {

constexpr double kNsPerUs = 1e3;
constexpr double kLongestJitter = 4;  // standard deviations

bool comes_later(const SensedEvent& a, const SensedEvent& b) { return SensedEventOrder{}(b, a); }

}  // namespace

void describe(config::Fields& fields, LatencyOptions& options) {
  constexpr double kLongest_us = 1e6;
  fields
      .value("mean_us", options.mean_us,
             "Delay of every time stamp behind the crossing, in microseconds.")
      .range(0, kLongest_us);
  fields
      .value("jitter_us", options.jitter_us,
             "Standard deviation of the delay from event to event, in microseconds.")
      .range(0, kLongest_us);
}

EventDelay::EventDelay(const LatencyOptions& options, int width, int height, TimeNs unit_ns,
                       std::uint64_t seed)
    : options_(options),
      width_(width),
      unit_ns_(unit_ns),
      random_(seed),
      pixels_(options.on() ? static_cast<std::size_t>(width) * static_cast<std::size_t>(height)
                           : 0) {}

double EventDelay::latency_ns(const SensedEvent& event, std::uint32_t index) const {
  double latency_us = options_.mean_us;
  if (options_.jitter_us > 0) {
    const double z = random_.normal(noise_stream(NoiseStream::kLatency, event.x, event.y), index);
    latency_us += options_.jitter_us * std::clamp(z, -kLongestJitter, kLongestJitter);
  }
  return kNsPerUs * std::max(0.0, latency_us);
}

void EventDelay::push(std::span<const SensedEvent> events) {
  const auto unit = static_cast<double>(unit_ns_);
  for (SensedEvent event : events) {
    Pixel& pixel =
        pixels_[static_cast<std::size_t>(event.y) * static_cast<std::size_t>(width_) + event.x];
    event.t_ns += unit_ns_ * std::llround(latency_ns(event, pixel.events) / unit);
    const TimeNs after = pixel.polarity != event.polarity ? unit_ns_ : 0;
    if (pixel.events > 0) event.t_ns = std::max(event.t_ns, pixel.last_ns + after);
    pixel = {event.t_ns, pixel.events + 1, event.polarity};
    waiting_.push_back(event);
    std::ranges::push_heap(waiting_, comes_later);
  }
}

void EventDelay::release(TimeNs complete_ns, SensedEvents& out) {
  while (!waiting_.empty() && waiting_.front().t_ns < complete_ns) {
    std::ranges::pop_heap(waiting_, comes_later);
    out.push_back(waiting_.back());
    waiting_.pop_back();
  }
}

void EventDelay::save(StateWriter& state) const {
  state.values(pixels_);
  state.values(waiting_);
}

void EventDelay::load(StateReader& state) {
  const std::size_t pixels = pixels_.size();
  state.values(pixels_);
  state.values(waiting_);
  if (pixels_.size() != pixels)
    throw InputError("saved state", "belongs to a sensor of another size or other latency");
}

}  // namespace saccade
