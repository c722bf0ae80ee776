#pragma once

#include <string>

#include "core/config/document.h"
#include "estimator/run/run_request.h"

namespace saccade {

/// `saccade run odometry`: poses and map from events alone and the poses of a short start.
RunSummary run_odometry(const RunRequest& request);

/// The resolved configuration, documented, as YAML.
[[nodiscard]] std::string print_odometry_config(const config::Document& document);

}  // namespace saccade
