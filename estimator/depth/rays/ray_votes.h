#pragma once

#include <cstddef>

#include <Eigen/Core>

#include "core/image.h"
#include "estimator/depth/rays/event_rays.h"

namespace saccade {

/// Adds, for each of the rays [begin, end), the unit vector p x'(rho) / |x'(rho)| to the pixel
/// nearest to x(rho): the direction in which the log intensity increases, as far as one event tells.
void vote_vectors(const EventRays& rays, std::size_t begin, std::size_t end, float inverse_depth,
                  Image<Eigen::Vector2f>& votes);

/// Adds 1 per ray, drawn bilinearly (A.3-A.7), for SweepDepth.
void vote_bilinear(const EventRays& rays, std::size_t begin, std::size_t end, float inverse_depth,
                   ImageF& votes);

}  // namespace saccade
