#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <vector>

#include "core/config/fields.h"
#include "eval/gate/comparison.h"
#include "eval/gate/gate_run.h"

namespace saccade {

void describe(config::Fields& fields, MachineTimes& times);
void describe(config::Fields& fields, GateRun& run);

/// Reads a baseline (docs/gate.md); the runs come sorted by their keys. InputError with file:line
/// for unknown keys, wrong types, another format version, two runs with the same key, and no runs.
[[nodiscard]] std::vector<GateRun> read_baseline(const std::filesystem::path& file);

/// compare_runs() with the baseline of a file; InputError where there is none.
[[nodiscard]] GateResult compare_with_baseline(const std::filesystem::path& file,
                                               std::span<const GateRun> runs,
                                               const GateOptions& options);

/// Writes the runs to the baseline, which keeps the times that it has of other kinds of machines;
/// with `partial` also those of its runs that are not among them. Returns how many it then holds.
std::size_t update_baseline(const std::filesystem::path& file, std::vector<GateRun> runs,
                            bool partial);

/// Writes a baseline sorted by key, one number per line, with exact doubles: equal runs give equal
/// bytes.
void write_baseline(const std::filesystem::path& file, std::vector<GateRun> runs);

}  // namespace saccade
