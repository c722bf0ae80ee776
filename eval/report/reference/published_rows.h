#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "core/config/document.h"
#include "core/io/run/run_record.h"

namespace saccade {

/// A score of another method that somebody published.
struct PublishedRow {
  std::string dataset;  ///< "Event Camera Dataset"
  std::string sequence;
  std::string method;
  std::string sensors;   ///< what the method uses
  std::string metric;    ///< key of metrics.json that it compares with
  double value = 0;      ///< in that key's unit
  std::string protocol;  ///< how it was measured
  std::string paper;     ///< of the method; empty where the source names none
  std::string citation;  ///< where the number was read
  std::string url;       ///< of that
  /// Settings of the configurations that it is compared with ("edges.samples or align.samples":
  /// either key); empty: of any.
  std::map<std::string, double> settings = {};
};

/// Whether a run's resolved configuration states all settings of the row.
[[nodiscard]] bool has_settings(const PublishedRow& row, const RunRecord& run);

/// The rows of a file such as reports/published.yaml (docs/public_datasets.md), by table, sequence
/// and method. InputError with file:line for unknown keys, a table without citation, method names
/// that stand twice, values that are negative or more or fewer than the methods. A value `~` is not
/// published.
[[nodiscard]] std::vector<PublishedRow> published_rows(const config::Document& document);
[[nodiscard]] std::vector<PublishedRow> read_published_rows(const std::filesystem::path& file);

}  // namespace saccade
