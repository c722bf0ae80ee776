#pragma once

#include "core/config/node.h"

namespace saccade::config {

/// Puts `over` upon `base`: maps are merged key by key, everything else is replaced, a null in
/// `over` removes the key from `base` (and stays, as a null, where `base` has no such key, so that
/// a misspelt key is still found).
void merge(Node& base, Node over);

/// Applies one "key.path=value" to a tree; the value replaces what was there, a null removes it.
/// Throws InputError with the location `--set key.path`.
void apply_override(Node& root, const std::string& assignment);

}  // namespace saccade::config
