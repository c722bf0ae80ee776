#pragma once

#include <string>

#include "core/config/node.h"

namespace saccade::config {

/// The YAML text of a tree, in the order of the tree; with `comments`, those of the entries behind
/// their keys.
[[nodiscard]] std::string to_yaml(const Node& node, bool comments = false);

/// The same on one line, as the value of `--set`.
[[nodiscard]] std::string to_flow_yaml(const Node& node);

}  // namespace saccade::config
