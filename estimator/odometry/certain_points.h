#pragma once

#include <vector>

#include "core/camera.h"
#include "estimator/depth/depth_estimator.h"

namespace saccade {

/// Of the points of a view keeps, in each of its 8 x 6 parts, the more certain ones: those whose
/// inverse depth has a relative sigma below `certain_sigma`, where these are few those below three
/// times as much, too, and where these are few all. A camera that is tracked by one near thing alone
/// cannot tell its turns from its way, however well that is known.
void keep_certain(const PinholeCamera& camera, double certain_sigma,
                  std::vector<EdgePoint>& points);

}  // namespace saccade
