#include <fmt/format.h>

#include <algorithm>
#include <optional>

#include "eval/report/leaderboard.h"
#include "eval/table/number_text.h"

namespace saccade {
namespace {

constexpr std::size_t kMostColumns = 12;  ///< of sequences: more cannot be read
constexpr const char* kSpeed = "speed.realtime_factor";

std::string board_caption(const Leaderboard& board) {
  return fmt::format("{}: {} is better; 95 % intervals over seeds{}", board.label,
                     board.higher_is_better ? "higher" : "lower",
                     board.sequences.size() > 1 ? ", over sequences for the overall score" : "");
}

/// As people are shown it.
PooledValue scaled(PooledValue value, double scale) {
  value.mean *= scale;
  if (value.low) *value.low *= scale;
  if (value.high) *value.high *= scale;
  return value;
}

/// "refused" of "refused: start: the events show no parallax"; the rest stands below it.
Table::Cell failure_cell(const std::string& problem) {
  const std::size_t end = problem.find(':');
  if (end == std::string::npos) return {problem};
  return {problem.substr(0, end), {}, problem};
}

Table::Cell score_cell(const LeaderboardScore& score, double scale) {
  if (!score.value) return score.failed > 0 ? failure_cell(score.problem) : Table::Cell{"–"};
  const PooledValue shown = scaled(*score.value, scale);
  if (score.failed == 0) return {"", shown, score.note};
  return {
      fmt::format("{} ({} of {} runs)", rounded(shown.mean), score.runs - score.failed, score.runs),
      shown, score.problem};
}

/// Of a method that failed, what it is a mean of.
Table::Cell overall_cell(const LeaderboardRow& row, double scale) {
  if (!row.overall) return {"–", {}};
  return {"", scaled(*row.overall, scale), row.failed > 0 ? "over successes" : ""};
}

Table::Cell rank_cell(const LeaderboardRow& row, std::size_t sequences) {
  if (row.rank == 0 && row.sequences == sequences) return {"–", {}};
  if (row.rank == 0) return {fmt::format("{} of {}", row.sequences, sequences), {}};
  return {std::to_string(row.rank), PooledValue{static_cast<double>(row.rank), {}, {}, 1}};
}

Table::Cell success_cell(const std::optional<SuccessShare>& success) {
  if (!success) return {"–", {}};
  return {"",
          scaled(PooledValue{success->value, success->low, success->high, success->count}, 100)};
}

/// How many of the runs did not fail, where no success is defined.
Table::Cell runs_cell(const LeaderboardRow& row) {
  const std::string text = row.failed == 0 ? std::to_string(row.runs)
                                           : fmt::format("{} ({} failed)", row.runs, row.failed);
  return {text, PooledValue{static_cast<double>(row.runs), {}, {}, 1}};
}

/// A number that sorts, where all runs had the same.
Table::Cell threads_cell(const LeaderboardRow& row) {
  if (row.threads.size() > 1) return {fmt::format("{}", fmt::join(row.threads, ", ")), {}};
  if (row.threads.empty()) return number_cell(std::nullopt);
  const int threads = *row.threads.begin();
  return number_cell(threads, std::to_string(threads));
}

/// The columns before those with scores.
std::vector<Table::Cell> method_cells(const LeaderboardRow& row, const Leaderboard& board) {
  const auto& known = row.method_class;
  std::vector<Table::Cell> cells{{row.method, {}, row.source},
                                 {known ? inputs_text(*known) : "unknown", {}},
                                 {known ? processing_text(*known) : "unknown", {}},
                                 rank_cell(row, board.sequences.size()),
                                 threads_cell(row)};
  if (board.key != kSpeed) cells.push_back(number_cell(row.realtime_factor));
  cells.push_back(runs_cell(row));
  return cells;
}

/// The best mean of a column within each class, of those without a failure; overall it is the first
/// rank.
void mark_best(Table& table, const Leaderboard& board, std::size_t first_column) {
  for (std::size_t column = first_column; column < table.columns.size(); ++column)
    for (std::size_t begin = 0, end = 0; begin < board.rows.size(); begin = end) {
      Table::Cell* best = nullptr;
      for (end = begin; end < board.rows.size() &&
                        board.rows[end].method_class == board.rows[begin].method_class;
           ++end) {
        Table::Cell& cell = table.rows[end][column];
        const LeaderboardRow& row = board.rows[end];
        const bool is_overall = table.columns[column].title == "overall";
        if (!cell.value || !cell.text.empty() || (is_overall && row.rank != 1)) continue;
        if (best == nullptr || (board.higher_is_better ? cell.value->mean > best->value->mean
                                                       : cell.value->mean < best->value->mean))
          best = &cell;
      }
      if (best != nullptr && end - begin > 1) best->best = true;
    }
}

}  // namespace

Table leaderboard_table(const Leaderboard& board) {
  const bool has_success =
      std::any_of(board.rows.begin(), board.rows.end(),
                  [](const LeaderboardRow& row) { return row.success.has_value(); });
  const bool has_columns = board.sequences.size() <= kMostColumns;
  Table table{"leaderboard_" + board.key,
              board_caption(board),
              {{"method"}, {"inputs"}, {"processing"}, {"rank", true}, {"threads", true}}};
  std::replace(table.name.begin(), table.name.end(), '.', '_');
  if (board.key != kSpeed) table.add_numeric({"× real time"});
  table.add_numeric({"runs"});
  if (has_success) table.add_numeric({"success [%]"});
  const std::size_t first_score = table.columns.size();
  if (board.sequences.size() > 1) table.add_numeric({"overall"});
  if (has_columns)
    for (const std::string& sequence : board.sequences) table.columns.push_back({sequence, true});
  for (const LeaderboardRow& row : board.rows) {
    std::vector<Table::Cell> cells = method_cells(row, board);
    if (has_success) cells.push_back(success_cell(row.success));
    if (board.sequences.size() > 1) cells.push_back(overall_cell(row, board.scale));
    if (has_columns)
      for (const LeaderboardScore& score : row.scores)
        cells.push_back(score_cell(score, board.scale));
    table.rows.push_back(std::move(cells));
  }
  mark_best(table, board, first_score);
  return table;
}

}  // namespace saccade
