#pragma once

#include <string>

#include "core/config/config.h"
#include "eval/sweep/plan/sweep_config.h"
#include "tests/support/command.h"

namespace saccade::testing {

/// A sweep as the file "sweep.yaml" in `folder` would state it, beside walls.yaml, accurate.yaml,
/// fast.yaml and a folder `recorded`.
inline SweepConfig read_sweep(const TemporaryFolder& folder, const std::string& yaml) {
  folder.write("walls.yaml", "seed: 1\n");
  folder.write("accurate.yaml", "align: {samples: 500}\n");
  folder.write("fast.yaml", "align: {samples: 50}\n");
  folder.write("recorded/events.txt", "0.1 0 0 1\n");
  return config::read<SweepConfig>(config::load(folder.write("sweep.yaml", yaml)));
}

}  // namespace saccade::testing
