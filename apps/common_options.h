#pragma once

#include <CLI/CLI.hpp>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/config/config.h"

namespace saccade {

/// Options that every verb with a configuration shares.
struct CommonOptions {
  std::vector<std::string> overrides;  ///< "key.path=value"
  std::optional<std::uint64_t> seed;
  std::string sensor;  ///< sensor.yaml, as key `sensor`; empty: none stated
  int threads = 0;     ///< 0: all cores
  bool quiet = false;
  bool print_config = false;

  /// Sets the process-wide thread count and the progress display.
  void apply() const;

  /// The configuration file (none: the defaults) with --set and --seed on top.
  [[nodiscard]] config::Document load(const std::string& config_file) const;
};

/// --threads and -q, for every verb.
void add_common_options(CLI::App& command, CommonOptions& options);
/// --set, for verbs that read a configuration if they are given one.
void add_override_option(CLI::App& command, CommonOptions& options);
/// --set, --seed and --print-config, for verbs that read a configuration.
void add_config_options(CLI::App& command, CommonOptions& options);
/// --sensor, for verbs whose configuration has the key `sensor`.
void add_sensor_option(CLI::App& command, CommonOptions& options);
/// --reference, for verbs whose page has this name: prints it in place of everything else.
void add_reference_option(CLI::App& command, const std::string& page);

}  // namespace saccade
