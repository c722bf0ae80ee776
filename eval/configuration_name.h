#pragma once

#include <filesystem>
#include <string>

#include "core/io/run/run_record.h"

namespace saccade {

/// What a person calls the configuration of a run: "best" of "-c configs/tracking/best.yaml", "best
/// align.samples=9" with what was --set (the seed apart, which every run states by itself),
/// "defaults" without a file; then ", estimated poses" and ", estimated depth" where another run's
/// took the place of the truth's. A run that no command line made is called by the first eight
/// digits of the SHA-256 of its resolved configuration.
[[nodiscard]] std::string configuration_name(const RunRecord& record);

/// The configuration file that the command names, as it names it; empty for none.
[[nodiscard]] std::filesystem::path configuration_file(const RunRecord& record);

/// SHA-256 of the resolved configuration; empty where the record holds none.
[[nodiscard]] std::string configuration_sha256(const RunRecord& record);

}  // namespace saccade
