#include "eval/sweep/result/ablation.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <tuple>
#include <utility>

#include "eval/evaluate.h"
#include "eval/gate/comparison.h"
#include "eval/metrics/catalogue.h"
#include "eval/statistics/signed_rank.h"
#include "eval/table/number_text.h"

namespace saccade {
namespace {

constexpr double kAlpha = 0.05;
constexpr const char* kTime = "speed.wall_s";

/// Runs of two methods that are compared have these in common.
using PairedBy =
    std::tuple<std::string, std::optional<std::uint64_t>, std::optional<std::uint64_t>>;

/// The rows of the table: what differs in dataset and seeds alone.
struct Method {
  std::string name;
  const SweepPoint* point = nullptr;
  std::map<PairedBy, const SweepRow*> rows;
};

/// Paired values of a method and of another one.
struct PairedValues {
  std::vector<double> own, other;

  [[nodiscard]] double mean(const std::vector<double>& values) const {
    double sum = 0;
    for (const double value : values) sum += value;
    return sum / static_cast<double>(values.size());
  }
};

std::string name_of(const SweepPoint& point, const SweepResults& results) {
  std::string name;
  const auto add = [&](const std::string& part) { name += (name.empty() ? "" : ", ") + part; };
  if (results.sweep.configurations.size() > 1 || results.sweep.variants.empty())
    add(point.configuration);
  if (!point.variant.empty()) add(point.variant);
  for (std::size_t i = 0; i < point.grid.size(); ++i)
    add(results.plan.axes[i] + " " + point.grid[i]);
  return name;
}

std::vector<Method> methods_of(const SweepResults& results) {
  std::vector<Method> methods;
  std::map<std::string, std::size_t> known;
  for (const SweepRow& row : results.rows) {
    const SweepPoint& point = row.job->point;
    const std::string name = name_of(point, results);
    const auto [found, is_new] = known.emplace(name, methods.size());
    if (is_new) methods.push_back({name, &point, {}});
    methods[found->second].rows.emplace(PairedBy{point.dataset, point.dataset_seed, point.seed},
                                        &row);
  }
  return methods;
}

/// The first row whose variant or configuration it is.
const Method* reference_of(const std::vector<Method>& methods, const std::string& reference) {
  const auto found = std::find_if(methods.begin(), methods.end(), [&](const Method& method) {
    return method.point->variant == reference || method.point->configuration == reference;
  });
  return found == methods.end() ? nullptr : &*found;
}

std::optional<double> value_of(const SweepRow& row, const std::string& metric) {
  return row.problem.empty() && !row.failed ? speed_value(row.metrics, metric) : std::nullopt;
}

PairedValues pairs_of(const Method& method, const Method& other, const std::string& metric) {
  PairedValues pairs;
  for (const auto& [key, row] : method.rows) {
    const auto partner = other.rows.find(key);
    if (partner == other.rows.end()) continue;
    const auto own = value_of(*row, metric), theirs = value_of(*partner->second, metric);
    if (!own || !theirs) continue;
    pairs.own.push_back(*own);
    pairs.other.push_back(*theirs);
  }
  return pairs;
}

/// Positive differences are better.
SignedRank test_of(const PairedValues& pairs, const MetricInfo& metric) {
  std::vector<double> differences;
  for (std::size_t i = 0; i < pairs.own.size(); ++i) {
    const double rise = pairs.own[i] - pairs.other[i];
    differences.push_back(metric.higher_is_better() ? rise : -rise);
  }
  return signed_rank_test(differences);
}

/// A method and a metric against the reference.
struct Comparison {
  const Method* method;
  MetricInfo metric;
  PairedValues pairs;
  SignedRank test;
  double p = 1;  ///< corrected
};

std::vector<Comparison> compare(const std::vector<Method>& methods, const Method& reference,
                                const std::vector<std::string>& metrics) {
  std::vector<Comparison> comparisons;
  std::vector<double> p;
  for (const Method& method : methods)
    for (const std::string& metric : metrics) {
      if (&method == &reference) continue;
      const MetricInfo info = metric_info(metric);
      PairedValues pairs = pairs_of(method, reference, metric);
      if (pairs.own.empty() || info.better == MetricInfo::Better::kNeither) continue;
      const SignedRank test = test_of(pairs, info);
      p.push_back(test.p);
      comparisons.push_back({&method, info, std::move(pairs), test});
    }
  const std::vector<double> corrected = holm(p);
  for (std::size_t i = 0; i < comparisons.size(); ++i) comparisons[i].p = corrected[i];
  return comparisons;
}

/// The method that is better than every other one beyond chance; nullptr: none is.
const Method* clear_best(const std::vector<Method>& methods, const std::string& metric) {
  const MetricInfo info = metric_info(metric);
  for (const Method& best : methods) {
    std::vector<double> p;
    bool is_best = methods.size() > 1 && info.better != MetricInfo::Better::kNeither;
    for (const Method& other : methods) {
      if (&other == &best || !is_best) continue;
      const PairedValues pairs = pairs_of(best, other, metric);
      const SignedRank test = test_of(pairs, info);
      is_best = !pairs.own.empty() && test.effect > 0;
      p.push_back(test.p);
    }
    const std::vector<double> corrected = holm(p);
    if (is_best && std::all_of(corrected.begin(), corrected.end(),
                               [](double value) { return value < kAlpha; }))
      return &best;
  }
  return nullptr;
}

std::optional<double> own_mean(const Method& method, const std::string& metric) {
  const PairedValues pairs = pairs_of(method, method, metric);
  return pairs.own.empty() ? std::nullopt : std::optional(pairs.mean(pairs.own));
}

/// Geometric mean over the pairs of the time of a run relative to the reference.
std::optional<double> relative_time(const Method& method, const Method& reference) {
  const PairedValues pairs = pairs_of(method, reference, kTime);
  double sum = 0;
  std::size_t count = 0;
  for (std::size_t i = 0; i < pairs.own.size(); ++i)
    if (pairs.own[i] > 0 && pairs.other[i] > 0) {
      sum += std::log(pairs.own[i] / pairs.other[i]);
      ++count;
    }
  return count == 0 ? std::nullopt : std::optional(std::exp(sum / static_cast<double>(count)));
}

/// Whether so few pairs can make no difference significant: the smallest p of the test of n pairs is
/// 2 / 2^n, which Holm's procedure multiplies by the number of tests.
bool is_hopeless(const std::vector<Comparison>& comparisons) {
  std::size_t most = 0;
  for (const Comparison& comparison : comparisons)
    most = std::max(most, comparison.pairs.own.size());
  return static_cast<double>(comparisons.size()) * std::pow(2.0, 1.0 - static_cast<double>(most)) >=
         kAlpha;
}

/// Whether rows have means over different pairs, as where some were stopped early.
bool has_different_counts(const std::vector<Method>& methods) {
  return std::any_of(methods.begin(), methods.end(), [&](const Method& method) {
    return method.rows.size() != methods.front().rows.size();
  });
}

Table summary_table(const std::vector<Method>& methods, const Method& reference,
                    const std::vector<std::string>& metrics,
                    const std::vector<Comparison>& comparisons) {
  Table table{.name = "ablation",
              .caption = fmt::format("Means over pairs of equal dataset and seed; * differs from "
                                     "{} (Wilcoxon, Holm, p < {})",
                                     reference.name, kAlpha),
              .columns = {{"method"}}};
  std::vector<const Method*> best;
  for (const std::string& metric : metrics) {
    table.columns.push_back({metric_info(metric).label, true});
    best.push_back(clear_best(methods, metric));
  }
  table.columns.push_back({"time [×]", true});
  const bool shows_pairs = has_different_counts(methods);
  if (shows_pairs) table.columns.push_back({"pairs", true});
  if (is_hopeless(comparisons))
    table.caption += "; with so few pairs no difference can be significant";
  for (const Method& method : methods) {
    std::vector<Table::Cell> row{{method.name}};
    for (std::size_t i = 0; i < metrics.size(); ++i) {
      const auto differs =
          std::any_of(comparisons.begin(), comparisons.end(), [&](const Comparison& comparison) {
            return comparison.method == &method &&
                   comparison.metric.key == metric_info(metrics[i]).key && comparison.p < kAlpha;
          });
      const std::optional<double> value = own_mean(method, metrics[i]);
      row.push_back(number_cell(value, rounded(value) + (differs ? "*" : "")));
      row.back().best = best[i] == &method;
    }
    const std::optional<double> time = relative_time(method, reference);
    row.push_back(number_cell(time, fixed(time, 2)));
    const auto pairs = static_cast<double>(method.rows.size());
    if (shows_pairs) row.push_back(number_cell(pairs, grouped(pairs)));
    table.rows.push_back(std::move(row));
  }
  return table;
}

Table test_table(const Method& reference, const std::vector<Comparison>& comparisons) {
  Table table{.name = "ablation_tests",
              .caption = "Against " + reference.name,
              .columns = {{"method"}, {"metric"}}};
  table.add_numeric({"pairs", "reference", "method's mean", "change [%]", "effect", "p"});
  for (const Comparison& comparison : comparisons) {
    const double before = comparison.pairs.mean(comparison.pairs.other);
    const double after = comparison.pairs.mean(comparison.pairs.own);
    std::optional<double> change;
    if (before != 0) change = 100 * (after - before) / std::abs(before);
    const auto pairs = static_cast<double>(comparison.pairs.own.size());
    table.rows.push_back({{comparison.method->name},
                          {comparison.metric.label},
                          number_cell(pairs, grouped(pairs)),
                          number_cell(before),
                          number_cell(after),
                          number_cell(change, change ? fmt::format("{:+.1f}", *change) : ""),
                          number_cell(comparison.test.effect, fixed(comparison.test.effect, 2)),
                          number_cell(comparison.p, fmt::format("{:.2g}", comparison.p))});
  }
  return table;
}

}  // namespace

std::vector<Table> ablation_tables(const SweepResults& results) {
  if (results.sweep.reference.empty()) return {};
  const std::vector<Method> methods = methods_of(results);
  const Method* reference = reference_of(methods, results.sweep.reference);
  if (reference == nullptr) return {};
  const std::vector<Comparison> comparisons = compare(methods, *reference, results.metrics);
  if (comparisons.empty()) return {};
  return {summary_table(methods, *reference, results.metrics, comparisons),
          test_table(*reference, comparisons)};
}

std::string ablation_section(const std::vector<Table>& tables, const std::string& reference) {
  if (tables.empty()) return "";
  std::string text = fmt::format("## Against {}\n", reference);
  for (const Table& table : tables) text += table.caption + ".\n\n" + table_markdown(table) + "\n";
  return text;
}

}  // namespace saccade
