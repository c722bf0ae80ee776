#pragma once

#include "core/config/fields.h"
#include "estimator/tracking/tracker.h"

namespace saccade {

/// How edges are tracked; of the module `track` and of others that do so.
void describe(config::Fields& fields, TrackerOptions& options);

/// Two parts of it: how a pose is found from the edges, ...
void describe_edges(config::Fields& fields, TrackerOptions& options);
/// ... and what is expected of it, and when it is given up.
void describe_expectation(config::Fields& fields, TrackerOptions& options);

}  // namespace saccade
