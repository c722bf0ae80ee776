#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "eval/store/result_store.h"

namespace saccade {

/// A text with stored results in place of its marks. A mark is {{RUNS METRIC}} or {{RUNS METRIC
/// DECIMALS}}:
///   RUNS      name of a run; each * in it stands for any text ("walls_track-thesis_*")
///   METRIC    key of metrics.json, or dataset.* of the runs' dataset; one without its value stands
///             for its median
///   DECIMALS  0 to 6; default: three significant digits
/// The number is the mean over the runs, of a speed their median, in the catalogue's scale; a dash
/// where none of them measured it, and of trajectories "lost" or "1 of 3 lost" where runs were.
/// `missing` stands in place of a mark of which no run is stored, if it is set. InputError with
/// `location` and the line of a mark that names no run otherwise, no metric or is malformed, with the
/// nearest right answer.
[[nodiscard]] std::string fill_page(std::string_view text, const std::string& location,
                                    ResultReader& reader,
                                    const std::optional<std::string>& missing = {});

}  // namespace saccade
