#include "eval/sweep/result/pooled_table.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <set>

#include "core/median.h"
#include "eval/evaluate.h"
#include "eval/metrics/catalogue.h"
#include "eval/sweep/result/dataset_information.h"
#include "eval/table/number_text.h"
#include "eval/table/table.h"

namespace saccade {
namespace {

/// Rows that differ in dataset and seeds alone.
struct PooledRows {
  SweepPoint point;  ///< of the first
  std::vector<const SweepRow*> rows;
};

bool is_same_method(const SweepPoint& a, const SweepPoint& b) {
  return a.module == b.module && a.configuration == b.configuration && a.variant == b.variant &&
         a.grid == b.grid;
}

std::vector<PooledRows> pool_over_datasets(const std::vector<SweepRow>& rows) {
  std::vector<PooledRows> pools;
  for (const SweepRow& row : rows) {
    const auto same = std::find_if(pools.begin(), pools.end(), [&](const PooledRows& pool) {
      return is_same_method(pool.point, row.job->point);
    });
    if (same == pools.end())
      pools.push_back({row.job->point, {&row}});
    else
      same->rows.push_back(&row);
  }
  return pools;
}

/// The smallest value that at least 90 % of them do not exceed.
double percentile_90(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  const double rank = std::ceil(0.9 * static_cast<double>(values.size()));
  return values[static_cast<std::size_t>(rank) - 1];
}

std::string spread_cell(const PooledRows& pool, const std::string& metric) {
  std::vector<double> values;
  for (const SweepRow* row : pool.rows)
    if (row->problem.empty())
      if (const auto value = speed_value(row->metrics, metric)) values.push_back(*value);
  if (values.empty()) return rounded(std::nullopt);
  const double mean =
      std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
  std::string cell = fmt::format("{} / {} / {}", rounded(mean), rounded(median(values)),
                                 rounded(percentile_90(values)));
  // A method that yields nothing where it is hard shall not look better for it.
  if (values.size() < pool.rows.size())
    cell += fmt::format(" ({} of {} runs)", values.size(), pool.rows.size());
  return cell;
}

/// Seconds of being lost, summed over the runs that report a status.
struct LossSeconds {
  double lost = 0;
  double reported = 0;
  double unreported = 0;
  double all = 0;  ///< scored
  double losses = 0;
  double delay = 0;  ///< from the begin of a loss to its report, over all losses
};

LossSeconds add_losses(const PooledRows& pool) {
  LossSeconds sum;
  for (const SweepRow* row : pool.rows) {
    const auto value = [&](const char* key) {
      return row->metrics.get(std::string("trajectory.") + key);
    };
    const auto unreported_s = value("loss.unreported_s"), lost_s = value("lost_s");
    if (!unreported_s || !lost_s || !row->problem.empty()) continue;
    sum.unreported += *unreported_s;
    sum.lost += *lost_s;
    sum.reported += value("loss.reported_s").value_or(0);
    sum.all += value("duration_s").value_or(0);
    sum.losses += value("loss.count").value_or(0);
    sum.delay += 1e-3 * value("loss.delay_ms").value_or(0) * value("loss.count").value_or(0);
  }
  return sum;
}

std::string percent(double part, double whole) {
  return rounded(whole > 0 ? std::optional(100 * part / whole) : std::nullopt);
}

std::vector<std::string> loss_cells(const PooledRows& pool) {
  const LossSeconds sum = add_losses(pool);
  const double both = sum.lost - sum.unreported;
  const auto delay_ms = sum.losses > 0 ? std::optional(1e3 * sum.delay / sum.losses) : std::nullopt;
  return {percent(sum.lost, sum.all), percent(both, sum.lost), percent(both, sum.reported),
          rounded(delay_ms), percent(sum.unreported, sum.all)};
}

std::string success_cell(std::span<const SweepRow* const> rows) {
  const std::optional<SuccessShare> share = success_of(rows);
  if (!share) return rounded(std::nullopt);
  return fmt::format("{} ({}–{})", rounded(100 * share->value), rounded(100 * share->low),
                     rounded(100 * share->high));
}

/// The rows whose dataset tells enough for their method.
std::vector<const SweepRow*> informed(const PooledRows& pool) {
  std::vector<const SweepRow*> rows;
  for (const SweepRow* row : pool.rows)
    if (has_enough(*row).value_or(false)) rows.push_back(row);
  return rows;
}

bool is_pooled_elsewhere(const std::string& metric) {
  return metric == "success" || metric == "trajectory.lost_s" ||
         metric.starts_with("trajectory.loss.");
}

/// The metrics of the sweep whose spread over the runs is shown.
std::vector<std::string> spread_metrics(const SweepResults& results,
                                        const std::vector<PooledRows>& pools) {
  std::vector<std::string> metrics;
  for (const std::string& metric : results.metrics)
    if (!is_pooled_elsewhere(metric) &&
        std::any_of(pools.begin(), pools.end(), [&](const PooledRows& pool) {
          return spread_cell(pool, metric) != rounded(std::nullopt);
        }))
      metrics.push_back(metric);
  return metrics;
}

bool has_losses(const std::vector<PooledRows>& pools) {
  return std::any_of(pools.begin(), pools.end(),
                     [](const PooledRows& pool) { return add_losses(pool).all > 0; });
}

std::string table_of_pools(const SweepResults& results, const std::vector<PooledRows>& pools) {
  const std::vector<std::string> metrics = spread_metrics(results, pools);
  const bool with_losses = has_losses(pools);
  const bool with_information =
      with_losses && std::any_of(results.rows.begin(), results.rows.end(),
                                 [](const SweepRow& row) { return row.information.has_value(); });
  Table table{.columns = {{"configuration"}}};
  if (!results.sweep.variants.empty()) table.columns.push_back({"variant"});
  for (const std::string& axis : results.plan.axes) table.columns.push_back({"`" + axis + "`"});
  table.add_numeric({"runs"});
  if (with_losses)
    table.add_numeric({"success [%]", "lost [% of time]", "loss recall [%]", "loss precision [%]",
                       "loss delay [ms]", "unreported [% of time]"});
  if (with_information) table.add_numeric({"success where the dataset tells enough [%]"});
  for (const std::string& metric : metrics)
    table.columns.push_back({metric_info(metric).label + " mean / median / 90 %", true});
  for (const PooledRows& pool : pools) {
    std::vector<std::string> cells{pool.point.configuration};
    if (!results.sweep.variants.empty()) cells.push_back(pool.point.variant);
    cells.insert(cells.end(), pool.point.grid.begin(), pool.point.grid.end());
    cells.push_back(std::to_string(pool.rows.size()));
    if (with_losses) {
      cells.push_back(success_cell(pool.rows));
      for (std::string& cell : loss_cells(pool)) cells.push_back(std::move(cell));
    }
    if (with_information) cells.push_back(success_cell(informed(pool)));
    for (const std::string& metric : metrics) cells.push_back(spread_cell(pool, metric));
    table.add(cells);
  }
  return table_markdown(table) + "\n";
}

}  // namespace

std::string pooled_table(const SweepResults& results) {
  // Of generated ones a row's point names the scene alone.
  std::set<std::string> datasets;
  for (const SweepRow& row : results.rows) datasets.insert(row.job->dataset);
  if (datasets.size() < 2 || results.plan.runs.empty()) return "";
  std::vector<std::vector<PooledRows>> modules;
  for (PooledRows& pool : pool_over_datasets(results.rows)) {
    const auto same = std::find_if(modules.begin(), modules.end(), [&](const auto& module) {
      return module.front().point.module == pool.point.module;
    });
    (same == modules.end() ? modules.emplace_back() : *same).push_back(std::move(pool));
  }
  std::string text = fmt::format(
      "## Over all {} datasets\nAll runs pooled over datasets and seeds; of losses the seconds of "
      "the runs are added. Success: the share of runs, with Wilson's 95 % interval.\n\n",
      datasets.size());
  for (const std::vector<PooledRows>& module : modules) {
    if (modules.size() > 1) text += "### " + module.front().point.module + "\n";
    text += table_of_pools(results, module);
  }
  return text;
}

}  // namespace saccade
