#pragma once

#include <filesystem>
#include <string>
#include <vector>

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
};

/// The rows of a file such as reports/published.yaml (docs/public_datasets.md), by table, sequence
/// and method. InputError with file:line for unknown keys, a table without citation, method names
/// that stand twice, values that are negative or more or fewer than the methods. A value `~` is not
/// published.
[[nodiscard]] std::vector<PublishedRow> read_published_rows(const std::filesystem::path& file);

}  // namespace saccade
