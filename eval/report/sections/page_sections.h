#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "eval/report/charts/page_chart.h"
#include "eval/report/leaderboard.h"
#include "eval/report/run_data.h"
#include "eval/report/run_set_comparison.h"
#include "eval/table/table.h"

namespace saccade {

/// The sections of a page that write_report() joins, as HTML; one without contents is empty.

/// The runs' methods against sequences. `published`: file of scores of other methods
/// (eval/report/reference/published_rows.h), of which those on the runs' sequences are taken, or
/// empty. Throws InputError as read_published_rows().
[[nodiscard]] std::vector<Leaderboard> leaderboards_of(std::span<const RunData> runs,
                                                       const std::filesystem::path& published);

/// The section with their tables; empty where there are none.
[[nodiscard]] std::string leaderboard_section(std::span<const Table> tables);

/// Methods against each other, in charts: error against speed, and for every sequence with several
/// methods the errors over time and their distributions. Empty where there is nothing to compare.
/// `boards`: of the runs. Appends the charts that the HTML refers to to those of the page.
[[nodiscard]] std::string compared_section(std::span<const RunData> runs,
                                           std::span<const Leaderboard> boards,
                                           std::vector<PageChart>& page);

/// Stated probabilities against the truth, a curve for each method in one chart, which is appended
/// to those of the page; empty where no run states any.
[[nodiscard]] std::string reliability_section(std::span<const RunData> runs,
                                              std::vector<PageChart>& page);

/// Every comparison of the gate: the metric on A and on B, the difference [%] with its interval,
/// and whether B is better, worse or equal.
[[nodiscard]] Table against_table(const RunSetComparison& comparison);

/// The section with this table, and for each sequence and method the errors of both sides over
/// time, of the first seed. Appends the charts to those of the page.
[[nodiscard]] std::string against_section(const RunSetComparison& comparison,
                                          std::vector<PageChart>& page);

/// The tables at the head of the page, each with its heading, as HTML. The thesis's number stands
/// below ours; factors are thesis / ours for errors and ours / thesis for speed, so above 1 is
/// better.

/// Thesis table 8.2; empty where no run has a trajectory score.
[[nodiscard]] std::string accuracy_table(std::span<const RunData> runs);
/// Scores of depth; empty where no run has any.
[[nodiscard]] std::string depth_table(std::span<const RunData> runs);
/// Thesis table 8.1, one row per dataset.
[[nodiscard]] std::string dataset_table(std::span<const RunData> runs);
/// Thesis table 8.3; empty where no run was timed.
[[nodiscard]] std::string speed_table(std::span<const RunData> runs);

/// The costly parts of a run's section.
struct RunSectionParts {
  bool pictures = true;  ///< drawn from its dataset; without, a note says where they are left out
  bool film = false;     ///< film_section()
};

/// Everything about one run below its heading, as HTML: key numbers, 3-D view, plots, pictures,
/// alignments, stages, provenance, the commands that repeat it. The views are filled by the page's
/// script from run_page_data(), which stands beside them.
[[nodiscard]] std::string run_section(const RunData& data, const RunSectionParts& parts);

/// The worst windows of every method, each with the map over the events: at most
/// three of a method, each of another run. Empty where no run has an error over time and a dataset.
[[nodiscard]] std::string failure_section(std::span<const RunData> runs);

/// Box plots of the relative errors over parts of the path (eval/metrics/trajectory/
/// relative_error.h), methods beside each other, for every sequence; empty where no run has any.
[[nodiscard]] std::string segment_section(std::span<const RunData> runs);

/// Pictures of a dataset: events, frame and depth at its middle. Empty without events.
[[nodiscard]] std::string dataset_pictures(const RunData& data);

}  // namespace saccade
