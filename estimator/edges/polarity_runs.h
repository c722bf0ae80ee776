#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/camera.h"
#include "core/event.h"

namespace saccade {

/// A polarity run: events of one polarity that a pixel fires in a row. The most that run_positions()
/// counts to: how far a run goes on says nothing of a single edge.
inline constexpr int kMaxRunPosition = 4;

/// Of every event its position in its polarity run, from 1 on and at most kMaxRunPosition: the
/// brightness has changed by so many contrasts since its change reversed, so that of an edge of some
/// width the first event is where it begins and later ones are farther in. 0 in the first run of a
/// pixel, which may have begun anywhere.
[[nodiscard]] std::vector<std::uint8_t> run_positions(std::span<const Event> events,
                                                      const PinholeCamera& camera);

/// The mean of the positions of some events, those of a pixel's first run left out; 0 for none.
[[nodiscard]] double mean_run_position(std::span<const std::uint8_t> positions,
                                       std::span<const std::uint32_t> events);

}  // namespace saccade
