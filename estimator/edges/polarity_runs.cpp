#include "estimator/edges/polarity_runs.h"

#include <cstddef>
#include <cstdlib>

#include "core/image.h"

namespace saccade {

std::vector<std::uint8_t> run_positions(std::span<const Event> events,
                                        const PinholeCamera& camera) {
  // Of every pixel the length of its run, with the sign of its polarity; of the first run, whose
  // beginning nobody saw, the sign alone, from kUnseen on.
  constexpr int kUnseen = kMaxRunPosition + 1;
  Image<int> run(camera.width, camera.height, 0);
  std::vector<std::uint8_t> positions(events.size());
  for (std::size_t i = 0; i < events.size(); ++i) {
    const int p = events[i].polarity;
    int& length = run(events[i].x, events[i].y);
    if (length == 0)
      length = kUnseen * p;
    else if (length * p < 0)
      length = p;
    else if (std::abs(length) < kMaxRunPosition)
      length += p;
    positions[i] = static_cast<std::uint8_t>(length * p == kUnseen ? 0 : length * p);
  }
  return positions;
}

double mean_run_position(std::span<const std::uint8_t> positions,
                         std::span<const std::uint32_t> events) {
  double sum = 0, count = 0;
  for (const std::uint32_t e : events)
    if (positions[e] > 0) sum += positions[e], ++count;
  return count > 0 ? sum / count : 0;
}

}  // namespace saccade
