#pragma once

#include <filesystem>
#include <span>

#include "core/trigger.h"

namespace saccade {

/// Lines `t type` below a comment that names the columns: seconds with 9 decimals.
void write_triggers(const std::filesystem::path& file, std::span<const Trigger> triggers);

}  // namespace saccade
