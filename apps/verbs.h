#pragma once

#include <CLI/CLI.hpp>

namespace saccade {

/// Each adds one verb with its options and help to the command; its callback does the work.
void add_simulate_verb(CLI::App& command);
void add_run_verb(CLI::App& command);
void add_eval_verb(CLI::App& command);
void add_report_verb(CLI::App& command);
void add_gate_verb(CLI::App& command);
void add_sweep_verb(CLI::App& command);
void add_results_verb(CLI::App& command);
void add_cache_verb(CLI::App& command);
void add_render_verb(CLI::App& command);
void add_info_verb(CLI::App& command);
void add_statistics_verb(CLI::App& command);
void add_calibrate_verb(CLI::App& command);
void add_convert_verb(CLI::App& command);
void add_view_verb(CLI::App& command);
void add_completion_verb(CLI::App& command);
void add_man_verb(CLI::App& command);

}  // namespace saccade
