#pragma once

#include <string>

#include "simulator/scene/animation/mesh_animation.h"
#include "simulator/scene/animation/node_animation.h"
#include "simulator/scene/mesh/model.h"

namespace saccade {

/// Between two poses of a MeshAnimation the vertices move on straight lines. No vertex departs by
/// more than this part of the model's size (the diagonal of the bounding box of its first pose) from
/// where the animation has it: of a model that fills a picture of a thousand pixels, a fiftieth of a
/// pixel, which is less than the photoreceptors of a sensor differ from each other.
constexpr double kChordError = 2e-5;

/// Poses of `model` at all keys of one of its animations, with as many between them as kChordError
/// asks for: an interval is halved until the poses at its quarters depart by less from its chord. A jump, as of stepped keys, takes kJump_s.
/// Throws InputError with `source_name` for a model that cannot be posed or whose animation moves
/// no vertex of it, for a vertex that is not finite, and where the poses would hold more than 2^27
/// vertices.
[[nodiscard]] MeshAnimation sample_animation(const Model& model, const ModelAnimation& animation,
                                             const std::string& source_name);

}  // namespace saccade
