#include "apps/common_options.h"

#include <fmt/core.h>

#include "apps/option_checks.h"
#include "apps/reference_page.h"
#include "core/process/parallel.h"
#include "core/process/progress.h"

namespace saccade {
namespace {

/// As a single-quoted YAML scalar, so that a path is text whatever it looks like.
std::string yaml_quoted(const std::string& text) {
  std::string quoted = "'";
  for (const char c : text) quoted += c == '\'' ? std::string("''") : std::string(1, c);
  return quoted + "'";
}

}  // namespace

void CommonOptions::apply() const {
  if (threads > 0) set_thread_count(threads);
  set_progress_quiet(quiet);
}

config::Document CommonOptions::load(const std::string& config_file) const {
  std::vector<std::string> all = overrides;
  if (seed) all.push_back("seed=" + std::to_string(*seed));
  if (!sensor.empty()) all.push_back("sensor=" + yaml_quoted(sensor));
  return config_file.empty() ? config::Document::empty(all) : config::load(config_file, all);
}

void add_common_options(CLI::App& command, CommonOptions& options) {
  command.add_option("--threads", options.threads, "Number of threads (default: all cores).")
      ->type_name("N")
      ->check(whole_number(1, 4096));
  command.add_flag("-q,--quiet", options.quiet, "Print errors only: no progress, no tables.");
}

void add_override_option(CLI::App& command, CommonOptions& options) {
  command
      .add_option("--set", options.overrides,
                  "Override one key, e.g. --set events.contrast_on=0.2 (repeatable).")
      ->type_name("KEY.PATH=VALUE")
      ->take_all()
      ->allow_extra_args(false);
}

void add_config_options(CLI::App& command, CommonOptions& options) {
  add_override_option(command, options);
  command
      .add_option("--seed", options.seed, "Seed of all random numbers; the same as --set seed=N.")
      ->type_name("N")
      ->check(whole_number(0, std::numeric_limits<std::uint64_t>::max()));
  command.add_flag("--print-config", options.print_config,
                   "Print every key with its value, help and range, and stop.");
}

void add_sensor_option(CLI::App& command, CommonOptions& options) {
  command
      .add_option("--sensor", options.sensor,
                  "Calibrated sensor (`saccade calibrate`); the same as --set sensor=FILE.")
      ->type_name("FILE");
}

void add_reference_option(CLI::App& command, const std::string& page) {
  command
      .add_flag_callback(
          "--reference",
          [page] {
            fmt::print("{}", reference_page(page).markdown());
            throw CLI::Success();
          },
          "Print every key of the configuration as a page of docs/reference/, and stop.")
      ->trigger_on_parse();
}

}  // namespace saccade
