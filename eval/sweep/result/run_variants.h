#pragma once

#include <filesystem>

#include "eval/store/result_diff.h"

namespace saccade {

/// The variants of the runs in a store of a sweep, DIR/runs/results.sqlite, as DIR/sweep.yaml names
/// them; none where that is no sweep.
[[nodiscard]] RunVariants run_variants(const std::filesystem::path& store);

}  // namespace saccade
