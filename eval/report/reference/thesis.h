#pragma once

#include <optional>
#include <string>

#include "core/io/run/run_record.h"

namespace saccade {

/// What the thesis (T. Horstschaefer, University of Zurich, 2016; tables 8.1 to 8.3 in thesis.yaml)
/// states for the metric on the sequence, in the metric's unit, with the setting that the run's
/// configuration is: its fast one (50 samples, 5 iterations), else its accurate one. nullopt where
/// it states nothing. Case of letters of the sequence does not matter.
[[nodiscard]] std::optional<double> thesis_value(const std::string& metric,
                                                 const std::string& sequence, const RunRecord& run);

/// What is wrong with a number that the thesis prints for the metric, and what stands in its place;
/// else the number of the table.
[[nodiscard]] std::string thesis_protocol(const std::string& metric);

}  // namespace saccade
