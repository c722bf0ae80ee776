#pragma once

#include <map>
#include <span>
#include <string>

#include "eval/report/site/published_report.h"

namespace saccade {

/// The file of a method's page in the folder methods of a site, for all methods of its reports.
[[nodiscard]] std::map<std::string, std::string> method_files(
    std::span<const PublishedReport> reports);

/// index.html of a site: its reports, the newest first, its methods, and a field that searches them
/// and all their runs.
[[nodiscard]] std::string site_index(std::span<const PublishedReport> reports);

/// The page of a method: its latest scores on every dataset, and each score over the reports, with
/// the reports from which on it has another level (change_points()).
[[nodiscard]] std::string method_page(const std::string& method,
                                      std::span<const PublishedReport> reports);

/// The script that the search loads on demand: all runs with their addresses from the index.
[[nodiscard]] std::string search_script(std::span<const PublishedReport> reports);

}  // namespace saccade
