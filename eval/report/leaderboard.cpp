#include "eval/report/leaderboard.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>

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
constexpr const char* kSuccess = "success";

using Entries = std::span<const LeaderboardEntry>;
using Runs = std::vector<const LeaderboardEntry*>;  ///< at least one

std::optional<double> score_of(const Metrics& metrics, const std::string& key) {
  if (key.starts_with("speed.")) return speed_value(metrics, key);
  const std::optional<double> value = metrics.get(key);
  if (key != kNees || !value) return value;
  return *value > 0 ? std::optional(nees_factor(*value)) : std::nullopt;
}

bool is_of_trajectories(const std::string& key) { return key.starts_with("trajectory."); }

/// The speed of a run that was lost says nothing of its method.
bool needs_success(const std::string& key) {
  return is_of_trajectories(key) || key.starts_with("speed.");
}

void add_once(std::vector<std::string>& names, const std::string& name) {
  if (std::find(names.begin(), names.end(), name) == names.end()) names.push_back(name);
}

/// Without a score of any kind.
bool came_to_nothing(const LeaderboardEntry& entry) {
  return !entry.problem.empty() ||
         (entry.metrics.get("trajectory.poses") == 0.0 && entry.metrics.get(kSuccess) == 0.0);
}

/// Whether a run counts as failed on the board of a metric.
bool has_failed(const LeaderboardEntry& entry, const std::string& key) {
  return !entry.problem.empty() || (needs_success(key) && entry.metrics.get(kSuccess) == 0.0);
}

/// Whether an entry that came to nothing would have had the metric.
bool is_expected(const LeaderboardEntry& entry, const std::string& key, Entries entries) {
  const auto is_of_module = [&](const LeaderboardEntry& other) {
    return other.module == entry.module && !came_to_nothing(other);
  };
  if (std::none_of(entries.begin(), entries.end(), is_of_module)) return is_of_trajectories(key);
  return std::any_of(entries.begin(), entries.end(), [&](const LeaderboardEntry& other) {
    return is_of_module(other) && score_of(other.metrics, key);
  });
}

bool stands_on(const LeaderboardEntry& entry, const std::string& key, Entries entries) {
  if (came_to_nothing(entry)) return is_expected(entry, key, entries);
  return score_of(entry.metrics, key).has_value();
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

/// The runs of a method on a sequence.
LeaderboardScore score_on(const std::string& sequence, const Runs& runs, const std::string& key) {
  LeaderboardScore score;
  std::vector<double> values, nees;
  for (const LeaderboardEntry* run : runs) {
    if (run->sequence != sequence) continue;
    ++score.runs;
    if (has_failed(*run, key)) {
      if (++score.failed == 1) score.problem = failure_text(run->metrics, run->problem);
      continue;
    }
    values.push_back(*score_of(run->metrics, key));
    if (key == kNees) nees.push_back(*run->metrics.get(kNees));
  }
  if (!values.empty()) score.value = pooled(values);
  if (!nees.empty()) score.note = nees_note(nees);
  return score;
}

std::optional<double> mean_realtime_factor(const Runs& runs, const std::string& key) {
  double sum = 0, count = 0;
  for (const LeaderboardEntry* run : runs) {
    const auto factor = speed_value(run->metrics, "speed.realtime_factor");
    if (!factor || !(*factor > 0) || has_failed(*run, key)) continue;
    sum += std::log(*factor);
    ++count;
  }
  return count > 0 ? std::optional(std::exp(sum / count)) : std::nullopt;
}

LeaderboardRow board_row(const Runs& runs, const Leaderboard& board) {
  LeaderboardRow row;
  row.method = runs.front()->method;
  row.source = runs.front()->source;
  row.method_class = runs.front()->method_class;
  std::vector<RunOutcome> outcomes;
  for (const LeaderboardEntry* run : runs) {
    if (run->threads > 0) row.threads.insert(run->threads);
    outcomes.push_back({run->metrics.get(kSuccess), !run->problem.empty()});
  }
  if (needs_success(board.key)) row.success = success_share(outcomes);
  row.realtime_factor = mean_realtime_factor(runs, board.key);
  for (const std::string& sequence : board.sequences) {
    row.scores.push_back(score_on(sequence, runs, board.key));
    row.runs += row.scores.back().runs;
    row.failed += row.scores.back().failed;
    row.sequences += row.scores.back().runs > 0 ? 1 : 0;
  }
  row.overall = geometric_mean(row);
  return row;
}

/// A run that came to nothing may not say of what class it is.
bool lacks_class(const LeaderboardEntry& entry) {
  return !entry.problem.empty() && !entry.method_class;
}

/// The runs that stand on the board, method by method and class by class; one that lacks a class has
/// that of its method's other runs, which come first.
std::vector<Runs> by_method(Entries entries, const Leaderboard& board) {
  std::vector<Runs> methods;
  for (const bool lacking : {false, true})
    for (const LeaderboardEntry& entry : entries) {
      if (lacks_class(entry) != lacking || !stands_on(entry, board.key, entries)) continue;
      const auto known = std::find_if(methods.begin(), methods.end(), [&](const Runs& runs) {
        return runs.front()->method == entry.method &&
               (runs.front()->method_class == entry.method_class || lacking);
      });
      (known == methods.end() ? methods.emplace_back() : *known).push_back(&entry);
    }
  return methods;
}

/// The number of sequences that any method of the row's class was run over.
std::size_t sequences_of_class(const LeaderboardRow& row, const Leaderboard& board) {
  std::size_t count = 0;
  for (std::size_t i = 0; i < board.sequences.size(); ++i)
    if (std::any_of(board.rows.begin(), board.rows.end(), [&](const LeaderboardRow& other) {
          return other.method_class == row.method_class && other.scores[i].runs > 0;
        }))
      ++count;
  return count;
}

/// Inputs and processing in order, what is not known behind.
auto order_of(const std::optional<MethodClass>& method_class) {
  const MethodClass known = method_class.value_or(MethodClass{});
  return std::tuple(!method_class, known.inputs, known.processing);
}

/// Class by class, those with all sequences first, then by the share that did not fail, then by the
/// overall score.
void sort_and_rank(Leaderboard& board) {
  std::vector<std::pair<LeaderboardRow, bool>> rows;  // whether it has all sequences
  for (const LeaderboardRow& row : board.rows)
    rows.emplace_back(row, row.sequences == sequences_of_class(row, board));
  const auto goodness = [&](const LeaderboardRow& row) {
    if (!row.overall) return -std::numeric_limits<double>::infinity();
    return board.higher_is_better ? row.overall->mean : -row.overall->mean;
  };
  std::stable_sort(rows.begin(), rows.end(), [&](const auto& a, const auto& b) {
    const auto key = [&](const auto& row) {
      return std::tuple(order_of(row.first.method_class), !row.second, -row.first.solved(),
                        -goodness(row.first));
    };
    return key(a) < key(b);
  });
  int rank = 0;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    LeaderboardRow& row = rows[i].first;
    if (i == 0 || rows[i - 1].first.method_class != row.method_class) rank = 0;
    if (rows[i].second && row.overall) row.rank = ++rank;
    board.rows[i] = row;
  }
}

Leaderboard empty_board(const MetricInfo& metric) {
  Leaderboard board;
  board.key = metric.key;
  board.label = metric.board;
  if (const std::string unit = metric.shown_unit(); !unit.empty()) board.label += " [" + unit + "]";
  board.scale = metric.scale;
  board.higher_is_better = metric.higher_is_better();
  return board;
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

std::vector<Leaderboard> leaderboards(Entries entries) {
  std::vector<Leaderboard> boards;
  for (const MetricInfo& metric : metric_catalogue()) {
    if (metric.board.empty()) continue;
    Leaderboard board = empty_board(metric);
    bool is_scored = false;
    for (const LeaderboardEntry& entry : entries) {
      is_scored = is_scored || score_of(entry.metrics, board.key);
      if (stands_on(entry, board.key, entries)) add_once(board.sequences, entry.sequence);
    }
    if (!is_scored) continue;
    for (const Runs& runs : by_method(entries, board)) board.rows.push_back(board_row(runs, board));
    sort_and_rank(board);
    boards.push_back(std::move(board));
  }
  return boards;
}

}  // namespace saccade
