#pragma once

#include <string>

#include "core/config/fields.h"

namespace saccade {

/// Successive halving (Jamieson and Talwalkar 2016): rows without hope are stopped early.
struct HalvingConfig {
  std::string metric;  ///< by which rows are ranked
  int first = 4;       ///< pairs of dataset and seed before the first decision
  double keep = 0.5;   ///< share of the rows that goes on
};

void describe(config::Fields& fields, HalvingConfig& halving);

}  // namespace saccade
