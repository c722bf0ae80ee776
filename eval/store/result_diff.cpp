#include "eval/store/result_diff.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <map>
#include <set>
#include <utility>

#include "core/config/suggest.h"
#include "core/error.h"
#include "core/median.h"
#include "eval/metrics/catalogue.h"

namespace saccade {
namespace {

using Rows = std::vector<ResultRow>;
using Indices = std::vector<std::size_t>;
using Better = MetricInfo::Better;

constexpr double kNothing = std::numeric_limits<double>::quiet_NaN();

bool is_commit(const ResultRow& row, const std::string& name) { return row.commit == name; }

bool begins_commit(const ResultRow& row, const std::string& name) {
  constexpr std::size_t kShortest = 4;
  return name.size() >= kShortest && row.commit.starts_with(name);
}

/// What a name may be of, and whether a row is named by it.
using Naming = std::pair<const char*, std::function<bool(const ResultRow&, const std::string&)>>;

std::vector<Naming> namings(const RunVariants& variants) {
  return {
      {"run", [](const ResultRow& row, const std::string& name) { return row.run == name; }},
      {"commit", is_commit},
      {"commit", begins_commit},
      {"version",
       [](const ResultRow& row, const std::string& name) { return row.version == name; }},
      {"config", [](const ResultRow& row, const std::string& name) { return row.config == name; }},
      {"variant",
       [&variants](const ResultRow& row, const std::string& name) {
         const auto found = variants.find(row.run);
         return found != variants.end() && found->second == name;
       }},
  };
}

/// Which of the rows a name means.
Indices named(const Rows& rows, const Naming& naming, const std::string& name) {
  Indices chosen;
  for (std::size_t i = 0; i < rows.size(); ++i)
    if (naming.second(rows[i], name)) chosen.push_back(i);
  return chosen;
}

[[noreturn]] void fail_names(const Rows& rows, const RunVariants& variants, const std::string& a,
                             const std::string& b) {
  std::set<std::string> names;
  for (const ResultRow& row : rows)
    for (const std::string& name : {row.run, row.commit, row.version, row.config})
      if (!name.empty()) names.insert(name);
  for (const auto& [run, variant] : variants)
    if (!variant.empty()) names.insert(variant);
  const std::vector<Naming> all_namings = namings(variants);
  for (const std::string& name : {a, b}) {
    const bool known =
        std::any_of(all_namings.begin(), all_namings.end(),
                    [&](const Naming& naming) { return !named(rows, naming, name).empty(); });
    if (known) continue;
    const std::vector<std::string> all(names.begin(), names.end());
    const auto near = config::nearest(name, all);
    throw InputError("--diff",
                     fmt::format("'{}' is no run, commit, version, configuration or variant here{}",
                                 name, near ? "; did you mean '" + *near + "'?" : ""));
  }
  throw InputError("--diff",
                   fmt::format("'{}' and '{}' are not of one kind: name two runs, commits, "
                               "versions, configurations or variants",
                               a, b));
}

std::string window_of(const ResultRow& row) {
  if (!row.start_s || !row.end_s) return {};
  return fmt::format("{:.2f}-{:.2f}", *row.start_s, *row.end_s);
}

PairKey key_of(const ResultRow& row) {
  return {row.dataset, row.module, row.config, window_of(row), row.seed};
}

using Groups = std::map<PairKey, Indices>;

Groups by_key(const Rows& rows, const Indices& chosen, const std::string& by) {
  Groups groups;
  for (const std::size_t i : chosen) {
    PairKey key = by == "run" ? PairKey() : key_of(rows[i]);
    if (by == "config" || by == "variant") key.config.clear();
    groups[key].push_back(i);
  }
  return groups;
}

double mean_of(const MetricTable& table, const Indices& runs, std::size_t metric) {
  double sum = 0;
  int count = 0;
  for (const std::size_t run : runs)
    if (const double value = table.at(run, metric); !std::isnan(value)) {
      sum += value;
      ++count;
    }
  return count == 0 ? kNothing : sum / count;
}

ResultPair pair_of(const PairKey& key, const MetricTable& table, const Indices& a,
                   const Indices& b) {
  ResultPair pair{key, {}};
  for (std::size_t metric = 0; metric < table.names().size(); ++metric)
    pair.changes.push_back({mean_of(table, a, metric), mean_of(table, b, metric)});
  return pair;
}

void add_pairs(const Rows& rows, const MetricTable& table, const Groups& groups_a, Groups groups_b,
               ResultDiff& diff) {
  const auto add_alone = [&](const Indices& runs) {
    for (const std::size_t run : runs) diff.alone.push_back(rows[run].run);
  };
  for (const auto& [key, runs] : groups_a) {
    const auto partner = groups_b.find(key);
    if (partner == groups_b.end()) {
      add_alone(runs);
      continue;
    }
    const PairKey shown = diff.by == "run" ? key_of(rows[runs.front()]) : key;
    diff.pairs.push_back(pair_of(shown, table, runs, partner->second));
    groups_b.erase(partner);
  }
  for (const auto& [key, runs] : groups_b) add_alone(runs);
}

void count_direction(const MetricChange& change, Better better, ChangeSummary& summary) {
  if (better == Better::kNeither || change.a == change.b) return;
  const bool rises = change.b > change.a;
  ++(rises == (better == Better::kHigher) ? summary.better : summary.worse);
}

ChangeSummary summary_of(const ResultDiff& diff, std::size_t metric) {
  ChangeSummary summary;
  summary.metric = diff.metrics[metric];
  const Better better = metric_info(summary.metric).better;
  std::vector<double> percents;
  for (const ResultPair& pair : diff.pairs) {
    const MetricChange& change = pair.changes[metric];
    if (!change.measured()) continue;
    ++summary.pairs;
    summary.a += change.a;
    summary.b += change.b;
    if (!std::isnan(change.percent())) percents.push_back(change.percent());
    count_direction(change, better, summary);
  }
  summary.a /= static_cast<double>(summary.pairs);
  summary.b /= static_cast<double>(summary.pairs);
  summary.median_percent = percents.empty() ? kNothing : median(std::move(percents));
  return summary;
}

}  // namespace

bool MetricChange::measured() const { return !std::isnan(a) && !std::isnan(b); }

double MetricChange::percent() const {
  if (a == b) return 0;
  return a == 0 ? kNothing : 100 * (b - a) / std::abs(a);
}

ResultDiff diff_results(ResultReader& reader, const std::string& a, const std::string& b,
                        std::string_view where, const RunVariants& variants) {
  const Rows rows = reader.select(where);
  for (const Naming& naming : namings(variants)) {
    const Indices runs_a = named(rows, naming, a);
    const Indices runs_b = named(rows, naming, b);
    if (runs_a.empty() || runs_b.empty()) continue;
    ResultDiff diff{a, b, naming.first, reader.metric_names(), {}, {}};
    const MetricTable table = reader.metrics(rows, diff.metrics);
    add_pairs(rows, table, by_key(rows, runs_a, diff.by), by_key(rows, runs_b, diff.by), diff);
    if (!diff.pairs.empty()) return diff;
    throw InputError("--diff",
                     fmt::format("no run of {0} '{1}' has a partner of {0} '{2}': the same "
                                 "dataset, module, window, configuration and seed",
                                 naming.first, a, b));
  }
  fail_names(rows, variants, a, b);
}

std::vector<ChangeSummary> summarise_changes(const ResultDiff& diff) {
  std::vector<ChangeSummary> summaries;
  for (std::size_t metric = 0; metric < diff.metrics.size(); ++metric) {
    ChangeSummary summary = summary_of(diff, metric);
    if (summary.pairs > 0) summaries.push_back(std::move(summary));
  }
  return summaries;
}

}  // namespace saccade
