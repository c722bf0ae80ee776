#pragma once

#include <vector>

#include "core/stopwatch.h"

namespace saccade {

/// Does the work as often as --repeat asks for and appends the wall time [s] of each repetition.
/// The work leaves the same result every time, so that only the last one is kept.
template <class Work>
void repeat_timed(int repeat, std::vector<double>& wall_s, const Work& work) {
  for (int i = 0; i < repeat; ++i) {
    const Stopwatch watch;
    work();
    wall_s.push_back(watch.seconds());
  }
}

}  // namespace saccade
