#pragma once

#include "core/config/fields.h"
#include "estimator/tracking/edges/edge_tracker.h"

namespace saccade {

/// The keys of the edge tracker with its motion model, as of odometry's section `tracking`.
void describe(config::Fields& fields, EdgeTrackerOptions& options);

/// The same without the motion model.
void describe_edges(config::Fields& fields, EdgeTrackerOptions& options);

/// The keys of the motion model, which all methods of tracking share.
void describe(config::Fields& fields, MotionModelOptions& options);

}  // namespace saccade
