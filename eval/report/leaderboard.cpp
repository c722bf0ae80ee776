#include "eval/report/leaderboard.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/check.h"
#include "eval/evaluate.h"
#include "eval/gate/bootstrap.h"
#include "eval/metrics/catalogue.h"
#include "eval/metrics/statistics.h"
#include "eval/metrics/trajectory/consistency.h"
#include "eval/table/number_text.h"

namespace saccade {
namespace {

constexpr const char* kNees = "trajectory.nees";

std::optional<double> score_of(const Metrics& metrics, const std::string& key) {
  if (key.starts_with("speed.")) return speed_value(metrics, key);
  const std::optional<double> value = metrics.get(key);
  if (key != kNees || !value) return value;
  return *value > 0 ? std::optional(nees_factor(*value)) : std::nullopt;
}

void add_once(std::vector<std::string>& names, const std::string& name) {
  if (std::find(names.begin(), names.end(), name) == names.end()) names.push_back(name);
}

/// Whether an entry without the score is shown all the same.
bool is_shown_failure(const LeaderboardEntry& entry, const std::string& key) {
  return !entry.problem.empty() && key.starts_with("trajectory.");
}

/// The NEES behind its factor: above 6 the estimator is surer than its errors allow.
std::string nees_note(std::span<const double> nees) {
  const double mean = pooled(nees).mean;
  return fmt::format("NEES {}, {}", rounded(mean),
                     mean > kNeesOfTruth ? "too sure" : "too cautious");
}

constexpr std::size_t kLeastSequences = 3;  ///< for an interval over them

/// Geometric mean of the scores; nullopt where there is none or one is not above 0.
std::optional<PooledValue> geometric_mean(const LeaderboardRow& row) {
  std::vector<double> logs;
  for (const LeaderboardScore& score : row.scores) {
    if (!score.value) continue;
    if (!(score.value->mean > 0)) return std::nullopt;
    logs.push_back(std::log(score.value->mean));
  }
  if (logs.empty()) return std::nullopt;
  const PooledValue mean = pooled(logs);
  // Two sequences say next to nothing of a third: their interval spans decades.
  const bool has_interval = logs.size() >= kLeastSequences;
  const auto exponential = [&](const std::optional<double>& end) {
    return end && has_interval ? std::optional(std::exp(*end)) : std::nullopt;
  };
  return PooledValue{std::exp(mean.mean), exponential(mean.low), exponential(mean.high),
                     mean.count};
}

LeaderboardRow board_row(const std::string& method, std::span<const LeaderboardEntry> entries,
                         const Leaderboard& board) {
  LeaderboardRow row{method, {}, {}, {}, 0, 0};
  for (const std::string& sequence : board.sequences) {
    LeaderboardScore score;
    std::vector<double> values, nees;
    for (const LeaderboardEntry& entry : entries) {
      if (entry.method != method || entry.sequence != sequence) continue;
      row.source = entry.source;
      const std::optional<double> value = score_of(entry.metrics, board.key);
      if (value) values.push_back(*value);
      if (value && board.key == kNees) nees.push_back(*entry.metrics.get(kNees));
      if (!value && is_shown_failure(entry, board.key) && ++score.failed == 1)
        score.problem = entry.problem;
    }
    if (!values.empty()) score.value = pooled(values);
    if (!nees.empty()) score.note = nees_note(nees);
    row.complete += score.complete() ? 1 : 0;
    row.scores.push_back(std::move(score));
  }
  row.overall = geometric_mean(row);
  return row;
}

/// Complete rows first, then by the overall score.
void sort_and_rank(Leaderboard& board) {
  const auto before = [&](const LeaderboardRow& a, const LeaderboardRow& b) {
    if (a.complete != b.complete) return a.complete > b.complete;
    if (!a.overall || !b.overall) return a.overall.has_value() && !b.overall;
    return board.higher_is_better ? a.overall->mean > b.overall->mean
                                  : a.overall->mean < b.overall->mean;
  };
  std::stable_sort(board.rows.begin(), board.rows.end(), before);
  int rank = 0;
  for (LeaderboardRow& row : board.rows)
    if (row.complete == board.sequences.size() && row.overall) row.rank = ++rank;
}

std::string board_caption(const Leaderboard& board) {
  return fmt::format("{}: {} is better; 95 % intervals over seeds{}", board.label,
                     board.higher_is_better ? "higher" : "lower",
                     board.sequences.size() > 1 ? ", over sequences for the overall score" : "");
}

/// As people are shown it.
std::optional<PooledValue> scaled(std::optional<PooledValue> value, double scale) {
  if (!value) return value;
  value->mean *= scale;
  if (value->low) *value->low *= scale;
  if (value->high) *value->high *= scale;
  return value;
}

Table::Cell score_cell(const LeaderboardScore& score, double scale) {
  if (!score.value) return {score.failed > 0 ? score.problem : "–", {}};
  const std::optional<PooledValue> shown = scaled(score.value, scale);
  if (score.failed == 0) return {"", shown, score.note};
  return {"", shown,
          fmt::format("{} of {} failed", score.failed, score.failed + score.value->count)};
}

/// The best mean of every column; of the overall scores only a ranked one counts.
void mark_best(Table& table, const Leaderboard& board) {
  for (std::size_t column = 2; column < table.columns.size(); ++column) {
    Table::Cell* best = nullptr;
    for (std::size_t i = 0; i < table.rows.size(); ++i) {
      Table::Cell& cell = table.rows[i][column];
      const bool counts = table.columns[column].title != "overall" || board.rows[i].rank > 0;
      if (!cell.value || !counts) continue;
      if (best == nullptr || (board.higher_is_better ? cell.value->mean > best->value->mean
                                                     : cell.value->mean < best->value->mean))
        best = &cell;
    }
    if (best != nullptr && table.rows.size() > 1) best->best = true;
  }
}

}  // namespace

PooledValue pooled(std::span<const double> values) {
  SACCADE_CHECK(!values.empty());
  const auto n = static_cast<double>(values.size());
  if (values.size() >= kLeastForBootstrap) {
    const BootstrapMean mean = bootstrap_mean(values, {.resamples = 2000, .tail = 0.025});
    return {mean.mean, mean.low, mean.high, values.size()};
  }
  PooledValue result{0, {}, {}, values.size()};
  for (const double value : values) result.mean += value / n;
  if (values.size() == 1) return result;
  double squares = 0;
  for (const double value : values) squares += (value - result.mean) * (value - result.mean);
  const double half = student_95(values.size() - 1) * std::sqrt(squares / (n - 1) / n);
  result.low = result.mean - half;
  result.high = result.mean + half;
  return result;
}

std::vector<Leaderboard> leaderboards(std::span<const LeaderboardEntry> entries) {
  std::vector<Leaderboard> boards;
  for (const MetricInfo& metric : metric_catalogue()) {
    if (metric.board.empty()) continue;
    Leaderboard board;
    board.key = metric.key;
    board.label = metric.board;
    if (const std::string unit = metric.shown_unit(); !unit.empty())
      board.label += " [" + unit + "]";
    board.scale = metric.scale;
    board.higher_is_better = metric.higher_is_better();
    std::vector<std::string> methods;
    for (const LeaderboardEntry& entry : entries) {
      const bool scored = score_of(entry.metrics, board.key).has_value();
      if (scored) add_once(board.sequences, entry.sequence);
      if (scored || is_shown_failure(entry, board.key)) add_once(methods, entry.method);
    }
    if (board.sequences.empty()) continue;
    for (const std::string& method : methods)
      board.rows.push_back(board_row(method, entries, board));
    sort_and_rank(board);
    boards.push_back(std::move(board));
  }
  return boards;
}

Table leaderboard_table(const Leaderboard& board) {
  const bool several = board.sequences.size() > 1;
  Table table{"leaderboard_" + board.key, board_caption(board), {{"method"}, {"rank", true}}};
  std::replace(table.name.begin(), table.name.end(), '.', '_');
  if (several) table.columns.push_back({"overall", true});
  for (const std::string& sequence : board.sequences) table.columns.push_back({sequence, true});
  for (const LeaderboardRow& row : board.rows) {
    std::vector<Table::Cell> cells{{row.method, {}, row.source}};
    if (row.rank > 0)
      cells.push_back(
          {std::to_string(row.rank), PooledValue{static_cast<double>(row.rank), {}, {}, 1}});
    else
      cells.push_back({fmt::format("{} of {}", row.complete, board.sequences.size()), {}});
    if (several) cells.push_back({row.overall ? "" : "–", scaled(row.overall, board.scale)});
    for (const LeaderboardScore& score : row.scores)
      cells.push_back(score_cell(score, board.scale));
    table.rows.push_back(std::move(cells));
  }
  mark_best(table, board);
  return table;
}

}  // namespace saccade
