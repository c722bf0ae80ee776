#include "eval/store/result_store.h"

#include <benchmark/benchmark.h>

#include <filesystem>
#include <string>
#include <vector>

#include "core/random.h"
#include "eval/store/result_diff.h"
#include "eval/store/result_text.h"
#include "tests/support/command.h"

namespace saccade {
namespace {

constexpr std::size_t kRuns = 10'000;
constexpr int kMetrics = 60;  // a run of odometry has about as many

/// Runs of ten configurations over five datasets, of two commits.
ResultRow made_up_row(std::size_t i) {
  const Random random(1);
  ResultRow row;
  row.run = "run_" + std::to_string(i);
  row.module = "track";
  row.dataset = "dataset_" + std::to_string(i % 5);
  row.config = "config_" + std::to_string(i / 5 % 10);
  row.seed = i / 100;
  row.start_s = 0;
  row.end_s = 2;
  row.version = "0.1.0";
  row.commit = i / 50 % 2 == 0 ? "aaaaaaaaaaaa" : "bbbbbbbbbbbb";
  row.config_yaml = std::string(4000, 'x');
  for (int k = 0; k < kMetrics - 1; ++k)
    row.metrics.set("group." + std::to_string(k), random.uniform(static_cast<std::uint64_t>(k), i));
  row.metrics.set("trajectory.dt_rel_percent.mean", random.uniform(99, i));
  return row;
}

/// A store that is written once for all benchmarks.
const std::filesystem::path& store() {
  static const testing::TemporaryFolder folder;
  static const std::filesystem::path file = [] {
    std::vector<ResultRow> rows;
    for (std::size_t i = 0; i < kRuns; ++i) rows.push_back(made_up_row(i));
    std::filesystem::path path = folder.path() / kResultStoreName;
    ResultStore(path).add(rows);
    return path;
  }();
  return file;
}

/// As `saccade results` does it, from opening the file to the text.
void list(benchmark::State& state, const char* where, ResultFormat format) {
  const std::filesystem::path& file = store();
  for ([[maybe_unused]] auto _ : state) {
    ResultReader reader(file);
    benchmark::DoNotOptimize(list_results(reader, where, {}, format));
  }
}

void diff(benchmark::State& state) {
  const std::filesystem::path& file = store();
  for ([[maybe_unused]] auto _ : state) {
    ResultReader reader(file);
    benchmark::DoNotOptimize(
        format_diff(diff_results(reader, "aaaaaaaaaaaa", "bbbbbbbbbbbb"), ResultFormat::kTable));
  }
}

void replace_one(benchmark::State& state) {
  const std::filesystem::path& file = store();
  const ResultRow row = made_up_row(kRuns / 2);
  for ([[maybe_unused]] auto _ : state) ResultStore(file).add({&row, 1});
}

constexpr const char* kFilter =
    "dataset like '%_1' and config = 'config_3' and trajectory.dt_rel_percent.mean < 0.5";

BENCHMARK_CAPTURE(list, all_as_table, "", ResultFormat::kTable)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(list, all_as_csv, "", ResultFormat::kCsv)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(list, all_as_json, "", ResultFormat::kJson)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(list, filtered, kFilter, ResultFormat::kTable)->Unit(benchmark::kMillisecond);
BENCHMARK(diff)->Unit(benchmark::kMillisecond);
BENCHMARK(replace_one)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace saccade
