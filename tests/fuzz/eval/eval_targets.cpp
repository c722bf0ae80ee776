// Scores, baselines, sweeps and conditions.

#include <fmt/format.h>

#include "core/config/config.h"
#include "core/error.h"
#include "eval/gate/baseline_file.h"
#include "eval/metrics/metrics.h"
#include "eval/store/database.h"
#include "eval/store/result_row.h"
#include "eval/store/where_expression.h"
#include "eval/sweep/plan/sweep_config.h"
#include "tests/fuzz/fuzz_target.h"

namespace saccade::fuzz {
namespace {

namespace fs = std::filesystem;

void write_metrics(const fs::path& folder) {
  Metrics metrics;
  metrics.set("trajectory.dt_rel_percent.mean", 0.25);
  metrics.set("depth.points", std::nullopt);
  write_bytes(folder / "metrics.json", to_json(metrics, {{"run", "abc"}}));
}

/// What was read is written and read again: the same.
void decode_metrics(const fs::path& folder, const std::string& file) {
  const Metrics metrics = read_json_metrics(folder / file);
  static_cast<void>(read_json_texts(folder / file, "inputs"));
  Metrics finite;
  for (const auto& [key, value] : metrics.values())
    if (value) finite.set("a." + std::to_string(finite.values().size()), value);
  if (parse_json_metrics(to_json(finite), "again") != finite)
    throw std::logic_error("what is written reads as something else");
}

void write_baselines(const fs::path& folder) {
  GateRun run;
  run.key = {"walls", "track", "best", 1};
  run.metrics["trajectory.dt_rel_percent.mean"] = 0.25;
  write_baseline(folder / "baseline.yaml", {run});
}

void decode_baselines(const fs::path& folder, const std::string& file) {
  static_cast<void>(read_baseline(folder / file));
}

void write_sweeps(const fs::path& folder) {
  write_bytes(
      folder / "sweep.yaml",
      "module: track\ndatasets: [{path: /tmp}]\nconfigurations: [{name: a, set: {x.z: 1}}]\n"
      "variants: [{name: b, set: {x.y: 2}}]\ngrid: {a.b: [1, 2, 3]}\nseeds: [1, 2]\nrepeat: 2\n");
}

void decode_sweeps(const fs::path& folder, const std::string& file) {
  auto sweep = config::read<SweepConfig>(config::load(folder / file));
  static_cast<void>(leave_out_absent(sweep));
}

void write_conditions(const fs::path& folder) {
  write_bytes(folder / "where.txt",
              "module = 'odometry' and dataset like \"walls%\" and (trajectory.drift_percent < "
              "1e-3 or not seed in "
              "(1, 2)) and 1 + 2 * 3 between 1 and 9");
}

/// What is let through is a condition that SQLite takes or refuses, and reads nothing else.
void decode_conditions(const fs::path& folder, const std::string& file) {
  const std::vector<std::string> metrics{"trajectory.drift_percent"};
  const auto sql = [](const std::string& name) {
    return name == "trajectory.drift_percent" ? std::string("drift") : std::string();
  };
  const WhereExpression where(read_bytes(folder / file), sql, metrics);
  static const fs::path database_file = [&] {
    fs::path path = folder / "results.sqlite";
    std::string columns = "drift REAL";
    for (const ResultColumn& column : result_columns())
      columns += fmt::format(", \"{}\" TEXT", column.name);
    Database(path, Database::Access::kWrite).run("CREATE TABLE runs (" + columns + ")");
    return path;
  }();
  Database database(database_file, Database::Access::kRead);
  SqlFault fault;
  const std::string prefix = "SELECT 1 FROM runs WHERE ";
  if (!database.try_prepare(prefix + where.sql(), fault)) where.fail(fault, prefix.size());
}

}  // namespace

const std::vector<Target>& targets() {
  static const std::vector<Target> all{
      {"metrics",
       {"metrics.json"},
       decode_metrics,
       write_metrics,
       {"null", "1e999", "-0.0", "{\"a\":", "[[[[[[[[", "\"inputs\":", "\\u0000", "NaN"}},
      {"baselines",
       {"baseline.yaml"},
       decode_baselines,
       write_baselines,
       {"format_version: 1", "runs:", "metrics:", "1e308", ".nan"}},
      {"sweeps",
       {"sweep.yaml"},
       decode_sweeps,
       write_sweeps,
       {"adapter:", "generate:", "expected:", "optional: true", "grid:", "configurations:", "../"}},
      {"conditions",
       {"where.txt"},
       decode_conditions,
       write_conditions,
       {"module", "dataset", "trajectory.drift_percent", " and ", " or ", " not ", "in (", "like ",
        "glob ", "is null", "between ", "--", "/*", ";", "select ", "''", "\"\""}}};
  return all;
}

}  // namespace saccade::fuzz
