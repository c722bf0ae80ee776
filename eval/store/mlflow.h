#pragma once

#include <cstddef>
#include <filesystem>
#include <string_view>

#include "eval/store/result_store.h"

namespace saccade {

/// Writes the runs for which `where` holds as an experiment of MLflow's file store, which `mlflow ui
/// --backend-store-uri FOLDER` shows: params (dataset, module, configuration, seed, window, machine
/// ...), metrics, tags (name, commit, command) and the resolved configuration as an artifact. A run
/// has the same identity in every call, so that one that is written again replaces itself. Metrics
/// without a value are left out; what else the folder holds is left alone. Returns the number
/// of runs. Throws InputError where the folder cannot be written, or as ResultReader::select().
std::size_t write_mlflow(ResultReader& reader, std::string_view where,
                         const std::filesystem::path& folder);

}  // namespace saccade
