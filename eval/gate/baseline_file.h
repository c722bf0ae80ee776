#pragma once

#include <filesystem>
#include <vector>

#include "core/config/fields.h"
#include "eval/gate/gate_run.h"

namespace saccade {

void describe(config::Fields& fields, GateRun& run);

/// Reads a baseline (docs/gate.md); the runs come sorted by their keys. InputError with file:line
/// for unknown keys, wrong types, another format version, two runs with the same key, and no runs.
[[nodiscard]] std::vector<GateRun> read_baseline(const std::filesystem::path& file);

/// Writes a baseline sorted by key, one number per line, with exact doubles: equal runs give equal
/// bytes.
void write_baseline(const std::filesystem::path& file, std::vector<GateRun> runs);

}  // namespace saccade
