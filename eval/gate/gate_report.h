#pragma once

#include <string>

#include "eval/gate/comparison.h"

namespace saccade {

/// The result for a terminal: the rows that regressed or improved (with `all` every row), the
/// notes, and the numbers of rows.
[[nodiscard]] std::string gate_text(const GateResult& result, bool all);

/// The same as a Markdown table, for a comment or a job summary.
[[nodiscard]] std::string gate_markdown(const GateResult& result);

/// Workflow commands of GitHub (and Forgejo, Gitea), one a line: an error for each row that regressed
/// and a warning for each note, both at `file`, the baseline; empty: at no file.
[[nodiscard]] std::string gate_annotations(const GateResult& result, const std::string& file);

/// JUnit XML: one test case per comparison, with a failure where it regressed.
[[nodiscard]] std::string gate_junit(const GateResult& result);

}  // namespace saccade
