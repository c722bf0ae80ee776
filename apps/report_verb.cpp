#include <fmt/core.h>

#include <filesystem>
#include <memory>
#include <vector>

#include "apps/command_line.h"
#include "apps/common_options.h"
#include "apps/verbs.h"
#include "eval/report/report.h"
#include "eval/store/result_store.h"

namespace saccade {
namespace {

struct ReportVerbOptions {
  std::vector<std::filesystem::path> runs;
  std::filesystem::path output;
  ReportOptions report;
  CommonOptions common;
};

void report(const ReportVerbOptions& options) {
  options.common.apply();
  ReportOptions report = options.report;
  report.command = command_line();
  report.against = without_store(report.against);
  write_report(without_store(options.runs), options.output, report);
  if (!options.common.quiet) fmt::print("wrote {}\n", options.output.string());
}

}  // namespace

void add_report_verb(CLI::App& command) {
  const auto options = std::make_shared<ReportVerbOptions>();
  CLI::App* verb =
      command.add_subcommand("report", "Write one self-contained HTML page about runs.");
  verb->add_option("RUN", options->runs, "Run folders, in the order of the page.")->required();
  verb->add_option("-o,--output", options->output, "HTML page to write.")
      ->required()
      ->type_name("FILE.html");
  verb->add_option("--title", options->report.title, "Title of the page.")->capture_default_str();
  verb->add_option("--published", options->report.published,
                   "File with published scores of other methods for the leaderboard, such as "
                   "reports/published.yaml.")
      ->type_name("FILE.yaml");
  verb->add_option("--against", options->report.against,
                   "Run folders of another build or configuration, which are paired with the runs.")
      ->type_name("RUN");
  verb->add_option("--export", options->report.exports,
                   "Folder for the tables of the leaderboard and of --against as LaTeX and CSV.")
      ->type_name("DIR");
  verb->add_flag("--video", options->report.film, "Add a short film of every run, made by ffmpeg.");
  add_common_options(*verb, options->common);
  verb->footer(
      "Examples:\n"
      "  saccade report runs/walls runs/planes -o report.html\n"
      "  saccade report new/* -o change.html --against old/*");
  verb->callback([options] { report(*options); });
}

}  // namespace saccade
