#pragma once

#include "tests/bench/study/scenario.h"

namespace saccade::study {

/// Records the scenario asynchronously and in frames of several lambdas, all with the ideal sensor
/// over the whole image, and prints one line for each: what it cost, and how much of the true
/// stream it found. The truth is brute force on three crops.
void print_ablation(const Scenario& scenario);

}  // namespace saccade::study
