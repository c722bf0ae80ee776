#include <fmt/core.h>

#include <filesystem>
#include <memory>
#include <vector>

#include "apps/command_line.h"
#include "apps/common_options.h"
#include "apps/verbs.h"
#include "core/error.h"
#include "eval/report/report.h"
#include "eval/report/site/publish.h"
#include "eval/store/result_store.h"

namespace saccade {
namespace {

struct ReportVerbOptions {
  std::vector<std::filesystem::path> runs;
  std::filesystem::path output;
  std::filesystem::path site;
  ReportOptions report;
  CommonOptions common;
};

void report(const ReportVerbOptions& options) {
  if (options.output.empty() && options.site.empty())
    throw InputError("report", "name the page (-o FILE.html) or the site (--publish DIR)");
  options.common.apply();
  ReportOptions report = options.report;
  report.command = command_line();
  report.against = without_store(report.against);
  const std::vector<std::filesystem::path> runs = without_store(options.runs);
  std::vector<std::filesystem::path> written;
  if (!options.output.empty()) {
    write_report(runs, options.output, report);
    written.push_back(options.output);
  }
  if (!options.site.empty()) {
    written.push_back(publish_report(runs, options.site, report));
    written.push_back(options.site / "index.html");
  }
  if (options.common.quiet) return;
  for (const std::filesystem::path& page : written) fmt::print("wrote {}\n", page.string());
}

}  // namespace

void add_report_verb(CLI::App& command) {
  const auto options = std::make_shared<ReportVerbOptions>();
  CLI::App* verb =
      command.add_subcommand("report", "Write a self-contained HTML page about runs, or a site.");
  verb->add_option("RUN", options->runs, "Run folders, in the order of the page.")->required();
  verb->add_option("-o,--output", options->output, "HTML page to write.")->type_name("FILE.html");
  verb->add_option("--publish", options->site,
                   "Add the report to a site of many reports in this folder, with a page for every "
                   "run and method, trends and a search; it needs no server.")
      ->type_name("DIR");
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
      "  saccade report new/* -o change.html --against old/*\n"
      "  saccade report runs/* --publish site --title \"Nightly, 31 January\"");
  verb->callback([options] { report(*options); });
}

}  // namespace saccade
