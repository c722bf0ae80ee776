#pragma once

#include <filesystem>
#include <span>

#include "eval/report/report.h"

namespace saccade {

/// Adds a report about the runs to a site, a folder of pages that needs no server, and returns the
/// page of the report:
///   SITE/index.html                      all reports and methods, with a search over all runs
///   SITE/methods/METHOD.html             a method's scores over the reports
///   SITE/reports/NAME/index.html         as write_report(), but for the sections of the runs,
///   SITE/reports/NAME/runs/RUN.html      each of which has a page of its own
///   SITE/reports/NAME/scores.json        what index and methods are made of
///   SITE/assets/                         script and style of all pages
/// NAME stays what it is: the same runs with the same title replace their report. The report
/// appears when it is complete; two programs that publish at once wait for each other. Throws as
/// write_report(), and InputError where `site` is something else.
std::filesystem::path publish_report(std::span<const std::filesystem::path> run_folders,
                                     const std::filesystem::path& site,
                                     const ReportOptions& options = {});

}  // namespace saccade
