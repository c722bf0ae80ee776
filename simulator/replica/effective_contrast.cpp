#include "simulator/replica/effective_contrast.h"

#include "core/image.h"

namespace saccade {

ContrastSums& ContrastSums::operator+=(const ContrastSums& other) {
  on += other.on;
  off += other.off;
  on_count += other.on_count;
  off_count += other.off_count;
  return *this;
}

std::optional<double> ContrastSums::mean_on() const {
  if (on_count == 0 || on <= 0) return std::nullopt;
  return on / on_count;
}

std::optional<double> ContrastSums::mean_off() const {
  if (off_count == 0 || off <= 0) return std::nullopt;
  return off / off_count;
}

ContrastSums contrast_sums(std::span<const SensedEvent> events, SensorSize size) {
  ContrastSums sums;
  Image<std::optional<float>> last(size.width, size.height);
  for (const SensedEvent& event : events) {
    std::optional<float>& before = last(event.x, event.y);
    if (before && event.origin == EventOrigin::kSignal) {
      const double change = event.log_intensity - *before;
      (event.polarity > 0 ? sums.on : sums.off) += event.polarity > 0 ? change : -change;
      (event.polarity > 0 ? sums.on_count : sums.off_count) += 1;
    }
    before = event.log_intensity;
  }
  return sums;
}

}  // namespace saccade
