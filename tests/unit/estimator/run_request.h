#pragma once

#include <filesystem>
#include <string>

#include "core/config/document.h"
#include "estimator/run/run_request.h"

namespace saccade::testing {

/// What `saccade run` asks of a module, with the configuration as YAML of the file t.yaml.
inline RunRequest run_request(const std::filesystem::path& dataset,
                              const std::filesystem::path& output, const std::string& yaml) {
  RunRequest request;
  request.dataset = dataset;
  request.output = output;
  request.config = config::parse(yaml, "t.yaml");
  return request;
}

}  // namespace saccade::testing
