#pragma once

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <span>
#include <vector>

#include "core/camera.h"
#include "core/event.h"
#include "core/image.h"

namespace saccade {

/// A polarity run: events of one polarity that a pixel fires in a row. The most that run_positions()
/// counts to: how far a run goes on says nothing of a single edge.
inline constexpr int kMaxRunPosition = 4;

/// Of every event its position in its polarity run, from 1 on and at most kMaxRunPosition: the
/// brightness has changed by so many contrasts since its change reversed, so that of an edge of some
/// width the first event is where it begins and later ones are farther in. 0 in the first run of a
/// pixel, which may have begun anywhere.
[[nodiscard]] inline std::vector<std::uint8_t> run_positions(std::span<const Event> events,
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

/// The mean of the positions of some events, those of a pixel's first run left out; 0 for none.
[[nodiscard]] inline double mean_run_position(std::span<const std::uint8_t> positions,
                                              std::span<const std::uint32_t> events) {
  double sum = 0, count = 0;
  for (const std::uint32_t e : events)
    if (positions[e] > 0) sum += positions[e], ++count;
  return count > 0 ? sum / count : 0;
}

}  // namespace saccade
