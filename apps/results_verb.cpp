#include <fmt/core.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <system_error>
#include <vector>

#include "apps/verbs.h"
#include "core/error.h"
#include "eval/report/filled_page.h"
#include "eval/store/mlflow.h"
#include "eval/store/result_diff.h"
#include "eval/store/result_store.h"
#include "eval/store/result_text.h"
#include "eval/store/result_trend.h"
#include "eval/sweep/result/run_variants.h"

namespace saccade {
namespace {

namespace fs = std::filesystem;

struct ResultsOptions {
  fs::path store;
  std::string where;
  std::vector<std::string> columns;
  std::vector<std::string> diff;
  std::string against;
  std::string format = "table";
  fs::path output;
  fs::path fill;
  std::optional<std::string> missing;
  std::vector<fs::path> add;
  fs::path scan;
  std::string trend;
  bool flaky = false;
};

ResultFormat format_of(const ResultsOptions& options) {
  static const std::map<std::string, ResultFormat> kFormats{
      {"table", ResultFormat::kTable}, {"csv", ResultFormat::kCsv}, {"json", ResultFormat::kJson}};
  return kFormats.at(options.format);
}

/// Every run folder below `folder`, or itself.
std::vector<fs::path> runs_below(const fs::path& folder) {
  if (!fs::is_directory(folder)) throw InputError(folder.string(), "is no folder (--scan)");
  if (fs::exists(folder / "run.yaml")) return {folder};
  std::vector<fs::path> runs;
  std::error_code error;
  for (auto at = fs::recursive_directory_iterator(folder, error);
       at != fs::recursive_directory_iterator(); at.increment(error)) {
    if (!at->is_directory(error)) continue;
    const bool hidden = at->path().filename().string().starts_with('.');  // unfinished
    const bool is_run = !hidden && fs::exists(at->path() / "run.yaml");
    if (is_run) runs.push_back(at->path());
    if (is_run || hidden) at.disable_recursion_pending();
  }
  if (runs.empty()) throw InputError(folder.string(), "holds no runs (--scan)");
  std::sort(runs.begin(), runs.end());
  return runs;
}

void add_runs(const std::vector<fs::path>& runs) {
  std::map<fs::path, std::vector<ResultRow>> rows;
  for (const fs::path& run : runs) rows[result_store_beside(run)].push_back(read_result(run));
  for (const auto& [store, added] : rows) {
    ResultStore(store).add(added);
    fmt::print("{}: {} {} added\n", store.string(), added.size(),
               added.size() == 1 ? "run" : "runs");
  }
}

/// --diff A B, or --diff B --against A.
std::vector<std::string> compared_sides(const ResultsOptions& options) {
  std::vector<std::string> sides = options.diff;
  if (!options.against.empty()) sides.insert(sides.begin(), options.against);
  if (sides.size() != 2)
    throw InputError("--diff", "name two sides: --diff A B, or --diff B --against A");
  return sides;
}

void show_results(const ResultsOptions& options) {
  std::vector<fs::path> runs = options.add;
  if (!options.scan.empty()) {
    const std::vector<fs::path> found = runs_below(options.scan);
    runs.insert(runs.end(), found.begin(), found.end());
  }
  if (!runs.empty()) return add_runs(runs);
  const fs::path store = find_result_store(options.store.empty() ? "." : options.store);
  ResultReader reader(store);
  if ((options.format == "mlflow") == options.output.empty())
    throw InputError("--format", options.output.empty()
                                     ? "mlflow needs the folder of MLflow's store: -o DIR"
                                     : "-o is for mlflow, the other formats are printed");
  if (options.format == "mlflow") {
    const std::size_t count = write_mlflow(reader, options.where, options.output);
    fmt::print("wrote {} {} to {}; mlflow ui --backend-store-uri {} shows them\n", count,
               count == 1 ? "run" : "runs", options.output.string(), options.output.string());
    return;
  }
  if (!options.fill.empty()) {
    std::ifstream file(options.fill);
    if (!file) throw InputError(options.fill.string(), "cannot be read (--fill)");
    const std::string text{std::istreambuf_iterator<char>(file), {}};
    fmt::print("{}", fill_page(text, options.fill.string(), reader, options.missing));
    return;
  }
  if (!options.trend.empty()) {
    fmt::print(
        "{}", format_trend(result_trend(reader, options.trend, options.where), format_of(options)));
    return;
  }
  if (options.flaky) {
    fmt::print("{}", format_flaky(flaky_metrics(reader, options.where), format_of(options)));
    return;
  }
  if (options.diff.empty()) {
    fmt::print("{}", list_results(reader, options.where, options.columns, format_of(options)));
    return;
  }
  if (!options.columns.empty())
    throw InputError("--columns", "is for the list of runs; --diff has columns of its own");
  const std::vector<std::string> sides = compared_sides(options);
  fmt::print("{}", format_diff(
                       diff_results(reader, sides[0], sides[1], options.where, run_variants(store)),
                       format_of(options)));
}

}  // namespace

void add_results_verb(CLI::App& command) {
  const auto options = std::make_shared<ResultsOptions>();
  CLI::App* verb = command.add_subcommand(
      "results",
      "List, filter and compare the stored results of runs (results.sqlite beside them).");
  verb->add_option("STORE", options->store,
                   "results.sqlite or the folder that holds it, also as runs/results.sqlite "
                   "(default: the working directory).");
  verb->add_option("--where", options->where,
                   "Condition over columns and metrics; text goes in quotes.")
      ->type_name("EXPR");
  verb->add_option("--columns", options->columns, "Columns and metrics to show.")
      ->type_name("NAME,...")
      ->delimiter(',')
      ->allow_extra_args(false);
  verb->add_option("--diff", options->diff,
                   "Compare two runs, or the runs of two commits, versions, configurations or "
                   "variants of a sweep that agree in dataset, module, window, configuration and "
                   "seed.")
      ->type_name("A B")
      ->expected(1, 2);
  verb->add_option("--against", options->against,
                   "With --diff B: what B is compared with, A of --diff A B.")
      ->type_name("A");
  verb->add_option("--trend", options->trend,
                   "Show a metric over the commits, with the commits at which its level changed.")
      ->type_name("METRIC");
  verb->add_flag("--flaky", options->flaky,
                 "List metrics that differ between runs of the same commit, dataset, "
                 "configuration, window, seed and machine.");
  verb->add_option("--format", options->format,
                   "Output format: table, csv, json, or mlflow, a folder that MLflow's pages show.")
      ->check(CLI::IsMember({"table", "csv", "json", "mlflow"}))
      ->capture_default_str();
  verb->add_option("-o,--output", options->output, "Folder of --format mlflow.")->type_name("DIR");
  verb->add_option("--fill", options->fill,
                   "Print a text with results in place of its marks {{RUNS METRIC}} or {{RUNS "
                   "METRIC DECIMALS}}; * in the name of a run stands for any text, and several "
                   "runs give their mean, of a speed their median.")
      ->type_name("FILE");
  verb->add_option("--missing", options->missing,
                   "With --fill: what stands in place of a mark of which no run is stored, e.g. "
                   "\"no run\"; without it such a mark is an error.");
  verb->add_option("--add", options->add, "Add runs to the stores beside them.")
      ->type_name("RUN...");
  verb->add_option("--scan", options->scan, "Add every run below a folder.")->type_name("FOLDER");
  verb->footer(
      "Examples:\n"
      "  saccade results runs\n"
      "  saccade results runs --where \"module = 'track' and trajectory.drift_percent < 1\"\n"
      "  saccade results runs --diff best fast\n"
      "  saccade results runs --trend trajectory.dt_rel_percent.mean\n"
      "  saccade results runs --format mlflow -o mlruns\n"
      "  saccade results runs --columns run,machine,speed.wall_s --format csv\n"
      "  saccade results runs --fill page.in.md > page.md\n"
      "  saccade results --scan runs");
  verb->callback([options] { show_results(*options); });
}

}  // namespace saccade
