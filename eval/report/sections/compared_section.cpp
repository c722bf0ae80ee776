#include "eval/report/sections/compared_section.h"

#include <fmt/format.h>

#include <algorithm>

#include "eval/report/charts/compared_errors.h"
#include "eval/report/charts/compared_speed.h"
#include "eval/report/html.h"

namespace saccade {
namespace {

/// Each once, in the order of the runs.
std::vector<std::string> names(std::span<const RunData> runs, std::string RunData::*name) {
  std::vector<std::string> result;
  for (const RunData& run : runs)
    if (std::find(result.begin(), result.end(), run.*name) == result.end())
      result.push_back(run.*name);
  return result;
}

/// Of the runs, then those that have published scores alone.
std::vector<std::string> all_methods(std::span<const RunData> runs,
                                     std::span<const Leaderboard> boards) {
  std::vector<std::string> methods = names(runs, &RunData::method);
  for (const Leaderboard& board : boards)
    for (const LeaderboardRow& row : board.rows)
      if (std::find(methods.begin(), methods.end(), row.method) == methods.end())
        methods.push_back(row.method);
  return methods;
}

std::string sequence_part(const std::string& sequence, std::span<const RunData> runs,
                          std::span<const Leaderboard> boards, const MethodStyles& styles,
                          std::vector<PageChart>& all) {
  std::vector<const RunData*> own;
  for (const RunData& run : runs)
    if (run.dataset == sequence) own.push_back(&run);
  std::string html = chart_grid(compared_errors(own, styles), all);
  const std::string speed = chart_grid(compared_speed(boards, sequence, styles), all);
  if (!speed.empty())
    html += fmt::format("<details><summary>Error against speed on {}</summary>\n{}</details>\n",
                        escape_html(sequence), speed);
  return html.empty() ? "" : fmt::format("<h3>{}</h3>\n{}", escape_html(sequence), html);
}

}  // namespace

std::string compared_section(std::span<const RunData> runs, std::span<const Leaderboard> boards,
                             std::vector<PageChart>& page) {
  const MethodStyles styles(all_methods(runs, boards));
  std::string html = chart_grid(compared_speed(boards, "", styles), page);
  if (!html.empty())
    html =
        "<p>Each method's score against its speed, as geometric means over the sequences of the "
        "table of the leaderboard, of methods that have all of them. The dashed steps are the "
        "Pareto front: no method is both faster and better than one on it.</p>\n" +
        html;
  std::string sequences;
  for (const std::string& sequence : names(runs, &RunData::dataset))
    sequences += sequence_part(sequence, runs, boards, styles, page);
  if (!sequences.empty())
    html +=
        "<p class=\"note\">Below, errors over time are those of a method's first run; "
        "distributions "
        "are of all its runs, whatever their seed.</p>\n" +
        sequences;
  if (html.empty()) return "";
  return "<section id=\"compared\"><h2>Compared</h2>\n" + html + "</section>\n";
}

}  // namespace saccade
