#include "eval/report/filled_page.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <numeric>
#include <optional>
#include <sstream>
#include <vector>

#include "core/config/suggest.h"
#include "core/error.h"
#include "core/median.h"
#include "eval/metrics/catalogue.h"
#include "eval/report/run_data.h"
#include "eval/table/number_text.h"

namespace saccade {
namespace {

constexpr std::string_view kOpen = "{{", kClose = "}}";

/// Whether `text` is `pattern` with any text for each *.
bool matches(std::string_view pattern, std::string_view text) {
  const std::size_t star = pattern.find('*');
  if (star == std::string_view::npos) return pattern == text;
  if (!text.starts_with(pattern.substr(0, star))) return false;
  const std::string_view rest = pattern.substr(star + 1);
  for (std::size_t at = star; at <= text.size(); ++at)
    if (matches(rest, text.substr(at))) return true;
  return false;
}

class PageFiller {
 public:
  PageFiller(ResultReader& reader, const std::optional<std::string>& missing)
      : reader_(reader), missing_(missing), rows_(reader.select("")) {}

  /// What stands in place of a mark; `place` is where it is.
  [[nodiscard]] std::string value_of(const std::string& mark, const std::string& place) {
    std::istringstream words(mark);
    std::string runs, metric, decimals, more;
    words >> runs >> metric >> decimals >> more;
    if (metric.empty() || !more.empty())
      throw InputError(place, "'" + mark +
                                  "' is no mark; write {{RUNS METRIC}} or {{RUNS METRIC "
                                  "DECIMALS}}");
    const std::vector<ResultRow> rows = rows_of(runs, place);
    if (rows.empty()) return *missing_;
    if (const std::string lost = lost_text(rows, metric); !lost.empty()) return lost;
    const std::optional<double> value = pooled(rows, metric, place);
    return decimals.empty() ? rounded(value) : fixed(value, number_of(decimals, place));
  }

 private:
  /// Of an error of the trajectory, where runs were lost: what they drifted to says nothing. Empty
  /// otherwise.
  [[nodiscard]] std::string lost_text(std::span<const ResultRow> rows, const std::string& metric) {
    constexpr const char* kFirstLoss = "trajectory.loss.first_s";
    if (!metric.starts_with("trajectory.") || metric.starts_with("trajectory.loss.") ||
        reader_.stored_metric(kFirstLoss).empty())
      return "";
    const std::size_t lost = scores(rows, kFirstLoss, "").size();
    if (lost == 0) return "";
    return lost == rows.size() ? "lost" : fmt::format("{} of {} lost", lost, rows.size());
  }

  [[nodiscard]] std::vector<ResultRow> rows_of(const std::string& pattern,
                                               const std::string& place) const {
    std::vector<ResultRow> rows;
    std::vector<std::string> names;
    for (const ResultRow& row : rows_) {
      names.push_back(row.run);
      if (matches(pattern, row.run)) rows.push_back(row);
    }
    if (rows.empty() && !missing_)
      throw InputError(place, "no stored run is called '" + pattern + "'; " +
                                  config::suggestion(pattern, names, "runs"));
    return rows;
  }

  [[nodiscard]] std::optional<double> pooled(std::span<const ResultRow> rows,
                                             const std::string& metric, const std::string& place) {
    constexpr std::string_view kDataset = "dataset.";
    const MetricInfo info = metric_info(metric);
    std::vector<double> values =
        metric.starts_with(kDataset) ? facts(rows, metric, place) : scores(rows, metric, place);
    if (values.empty()) return std::nullopt;
    const double value = info.is_speed ? median(values)
                                       : std::accumulate(values.begin(), values.end(), 0.0) /
                                             static_cast<double>(values.size());
    return info.scale * value;
  }

  [[nodiscard]] std::vector<double> scores(std::span<const ResultRow> rows,
                                           const std::string& metric, const std::string& place) {
    const std::string stored = reader_.stored_metric(metric);
    if (stored.empty())
      throw InputError(place, "'" + metric + "' is no metric of a stored run; " +
                                  config::suggestion(metric, reader_.metric_names(), "metrics"));
    const MetricTable table = reader_.metrics(rows, {stored});
    std::vector<double> values;
    for (std::size_t row = 0; row < rows.size(); ++row)
      if (!std::isnan(table.at(row, 0))) values.push_back(table.at(row, 0));
    return values;
  }

  [[nodiscard]] static std::vector<double> facts(std::span<const ResultRow> rows,
                                                 const std::string& metric,
                                                 const std::string& place) {
    std::vector<double> values;
    for (const ResultRow& row : rows) {
      const Metrics all = facts_of(Dataset::open(row.dataset_path));
      if (!all.values().contains(metric)) {
        std::vector<std::string> names;
        for (const auto& [name, value] : all.values()) names.push_back(name);
        throw InputError(place, "'" + metric + "' is not known of a dataset; " +
                                    config::suggestion(metric, names, "facts"));
      }
      if (const std::optional<double> value = all.get(metric)) values.push_back(*value);
    }
    return values;
  }

  [[nodiscard]] static int number_of(const std::string& text, const std::string& place) {
    int number = -1;
    const char* const end = text.data() + text.size();
    const auto parsed = std::from_chars(text.data(), end, number);
    if (parsed.ec != std::errc{} || parsed.ptr != end || number < 0 || number > 6)
      throw InputError(place, "'" + text + "' is no number of decimals; write 0 to 6");
    return number;
  }

  ResultReader& reader_;
  std::optional<std::string> missing_;
  std::vector<ResultRow> rows_;
};

}  // namespace

std::string fill_page(std::string_view text, const std::string& location, ResultReader& reader,
                      const std::optional<std::string>& missing) {
  PageFiller filler(reader, missing);
  std::string filled;
  std::size_t at = 0;
  for (std::size_t open = text.find(kOpen); open != std::string_view::npos;
       open = text.find(kOpen, at)) {
    const std::string place = fmt::format(
        "{}:{}", location,
        1 + std::count(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(open), '\n'));
    const std::size_t close = text.find(kClose, open);
    if (close == std::string_view::npos) throw InputError(place, "'{{' has no '}}'");
    const std::size_t begin = open + kOpen.size();
    filled += text.substr(at, open - at);
    filled += filler.value_of(std::string(text.substr(begin, close - begin)), place);
    at = close + kClose.size();
  }
  return filled += text.substr(at);
}

}  // namespace saccade
