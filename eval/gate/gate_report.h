#pragma once

#include <string>

#include "eval/gate/comparison.h"

namespace saccade {

/// For a terminal: what regressed and what improved (with `all` also what did neither), by how much
/// and how sure, notes, and a line that counts.
[[nodiscard]] std::string gate_text(const GateResult& result, bool all);

/// The same as a Markdown table of all rows that regressed or improved, for a comment or a job's
/// summary.
[[nodiscard]] std::string gate_markdown(const GateResult& result);

/// JUnit XML: a test case for each comparison, a failure for each that regressed.
[[nodiscard]] std::string gate_junit(const GateResult& result);

}  // namespace saccade
