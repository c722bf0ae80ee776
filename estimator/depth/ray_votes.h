#pragma once

#include <cstddef>

#include <Eigen/Core>

#include "core/image.h"
#include "estimator/depth/event_rays.h"

namespace saccade {

/// Adds, for each of the rays [begin, end), the unit vector p x'(rho) / |x'(rho)| to the pixel
/// nearest to x(rho): the direction in which the log intensity rises, as far as one event can tell.
void vote_vectors(const EventRays& rays, std::size_t begin, std::size_t end, float inverse_depth,
                  Image<Eigen::Vector2f>& votes);

/// The same with (1, 0) for every ray: a count.
void vote_counts(const EventRays& rays, std::size_t begin, std::size_t end, float inverse_depth,
                 Image<Eigen::Vector2f>& votes);

/// Bilinear counts (thesis A.3-A.7), for the space sweep that stands alone.
void vote_bilinear(const EventRays& rays, std::size_t begin, std::size_t end, float inverse_depth,
                   ImageF& votes);

}  // namespace saccade
