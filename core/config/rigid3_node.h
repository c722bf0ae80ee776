#pragma once

#include <string>

#include "core/config/node.h"
#include "core/rigid3.h"

// In the namespace of Rigid3, where the templates of Fields find them.
namespace saccade {

/// A rigid transformation as the four rows of its 4 x 4 matrix. from_node throws InputError at the
/// node's location unless they are a rotation (to 1e-3), a translation, and 0 0 0 1 below.
void from_node(const config::Node& node, const std::string& name, Rigid3& value);
[[nodiscard]] config::Node to_node(const Rigid3& value);

}  // namespace saccade
