#pragma once

#include <memory>
#include <string_view>

#include "core/config/node.h"

namespace saccade::config {

/// Turns YAML text (one document) into a tree whose places name `source`; with `lines` false (one
/// value on a command line) they have no line. Empty text is a null node. Throws InputError for
/// syntax errors, duplicate keys, keys that are no text, explicit tags, a second document, and
/// trees too deep or too large (recursive anchors).
[[nodiscard]] Node parse_yaml(std::string_view text, const std::shared_ptr<const Source>& source,
                              bool lines = true);

}  // namespace saccade::config
