#pragma once

#include <span>
#include <string>
#include <vector>

#include "core/config/document.h"
#include "core/config/reference.h"
#include "estimator/run/run_request.h"

namespace saccade {

/// One estimator that `saccade run` offers.
struct Module {
  const char* name;
  const char* help;          ///< one sentence
  bool takes_poses = false;  ///< from the ground truth or RunRequest::poses_from
  bool takes_depth = false;  ///< from the dataset or RunRequest::depth_from
  bool takes_run = false;    ///< RunRequest::from
  /// Runs over a dataset and writes the run folder. Throws InputError for bad input.
  RunSummary (*run)(const RunRequest&) = nullptr;
  /// The resolved configuration, documented, as YAML. Throws InputError for a bad one.
  std::string (*print_config)(const config::Document&) = nullptr;
  /// All keys of the configuration, for docs/reference/.
  std::vector<config::ReferenceKey> (*reference)() = nullptr;
};

/// All modules. A new one is a row here and the files of its folder.
[[nodiscard]] std::span<const Module> modules();

/// Throws InputError that lists the modules when there is none of this name.
[[nodiscard]] const Module& find_module(const std::string& name);

/// find_module(name).run(request).
RunSummary run_module(const std::string& name, const RunRequest& request);

}  // namespace saccade
