#pragma once

#include <filesystem>
#include <vector>

#include "core/config/fields.h"
#include "eval/gate/gate_run.h"

namespace saccade {

void describe(config::Fields& fields, GateRun& run);

/// Reads a baseline (docs/gate.md), in the order of the keys. InputError with file:line for unknown
/// keys, wrong types, another version of the format, two runs with one key, or none at all.
[[nodiscard]] std::vector<GateRun> read_baseline(const std::filesystem::path& file);

/// Writes it sorted, one number a line, doubles exact: equal runs give equal bytes.
void write_baseline(const std::filesystem::path& file, std::vector<GateRun> runs);

}  // namespace saccade
