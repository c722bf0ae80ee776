#include "eval/report/reference/thesis.h"

#include <algorithm>
#include <cctype>
#include <span>
#include <vector>

#include "core/check.h"
#include "eval/report/assets.h"
#include "eval/report/reference/published_rows.h"

namespace saccade {
namespace {

std::span<const PublishedRow> thesis_rows() {
  static const std::vector<PublishedRow> rows =
      published_rows(config::parse(assets::thesis_yaml, "thesis.yaml"));
  return rows;
}

bool same_letters(const std::string& a, const std::string& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](unsigned char x, unsigned char y) {
    return std::tolower(x) == std::tolower(y);
  });
}

/// The column of the metric's table that names the run's configuration, else the one that names
/// none.
std::string column_of(const std::string& metric, const RunRecord& run) {
  std::string any;
  for (const PublishedRow& row : thesis_rows()) {
    if (row.metric != metric) continue;
    if (row.settings.empty())
      any = row.method;
    else if (has_settings(row, run))
      return row.method;
  }
  return any;
}

}  // namespace

std::optional<double> thesis_value(const std::string& metric, const std::string& sequence,
                                   const RunRecord& run) {
  const std::string column = column_of(metric, run);
  for (const PublishedRow& row : thesis_rows())
    if (row.metric == metric && row.method == column && same_letters(row.sequence, sequence))
      return row.value;
  return std::nullopt;
}

std::string thesis_protocol(const std::string& metric) {
  const std::span<const PublishedRow> rows = thesis_rows();
  const auto row = std::find_if(rows.begin(), rows.end(),
                                [&](const PublishedRow& each) { return each.metric == metric; });
  SACCADE_CHECK(row != rows.end());
  return row->protocol;
}

}  // namespace saccade
