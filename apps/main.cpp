#include <fmt/core.h>

#include <CLI/CLI.hpp>
#include <exception>
#include <filesystem>
#include <string>
#include <vector>

#include "apps/command_line.h"
#include "apps/usage_error.h"
#include "apps/verbs.h"
#include "core/error.h"
#include "core/process/fork_server.h"
#include "core/process/interruption.h"
#include "core/refused_path.h"
#include "core/version.h"

namespace saccade {
namespace {

enum ExitCode { kDone = 0, kFailed = 1, kBadInput = 2 };

void describe_command(CLI::App& command) {
  command.description(
      "saccade: simulate event cameras, estimate motion from their events, score the result.\n");
  command.footer(
      "Example, from a mesh to a scored trajectory:\n"
      "  saccade simulate configs/simulation/walls.yaml -o data/walls\n"
      "  saccade run track --data data/walls -c configs/tracking/accurate.yaml -o runs/walls\n"
      "  saccade eval runs/walls\n"
      "  saccade report runs/walls -o report.html\n"
      "  saccade view runs/walls\n\n"
      "Exit codes: 0 done, 1 failed, 2 bad usage or bad input, 128 + signal where one ended it.");
  command.set_version_flag("--version", fmt::format("saccade {} ({})", version(), git_commit()));
  command.require_subcommand(1);
  command.get_formatter()->column_width(32);
  add_simulate_verb(command);
  add_run_verb(command);
  add_eval_verb(command);
  add_report_verb(command);
  add_gate_verb(command);
  add_sweep_verb(command);
  add_results_verb(command);
  add_cache_verb(command);
  add_render_verb(command);
  add_view_verb(command);
  add_info_verb(command);
  add_statistics_verb(command);
  add_calibrate_verb(command);
  add_convert_verb(command);
  add_completion_verb(command);
  add_man_verb(command);
}

int run_command(int argc, char** argv) {
  set_command_line(argc, argv);
  CLI::App command;
  describe_command(command);
  try {
    command.parse(argc, argv);
    return kDone;
  } catch (const CLI::Success& success) {
    return command.exit(success);  // --help and --version
  } catch (const CLI::ParseError& error) {
    const std::vector<std::string> arguments(argv + 1, argv + argc);
    fmt::print(stderr, "saccade: {}\n", explain_usage_error(command, error, arguments));
    return kBadInput;
  } catch (const InputError& error) {
    fmt::print(stderr, "saccade: {}\n", error.what());
    return kBadInput;
  } catch (const std::filesystem::filesystem_error& error) {
    const auto refusal = refused_path(error);
    fmt::print(stderr, "saccade: {}{}\n",
               refusal ? "" : "failed: ", refusal ? refusal->what() : error.what());
    return refusal ? kBadInput : kFailed;
  } catch (const std::exception& error) {
    fmt::print(stderr, "saccade: failed: {}\n", error.what());
    return kFailed;
  }
}

}  // namespace
}  // namespace saccade

int main(int argc, char** argv) {
  const auto run = [](int count, char** words) {
    saccade::end_on_interruption();
    return saccade::run_command(count, words);
  };
  return saccade::is_fork_server(argc, argv) ? saccade::serve_forks(run) : run(argc, argv);
}
