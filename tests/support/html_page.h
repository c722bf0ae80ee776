#pragma once

#include <string>
#include <vector>

namespace saccade::testing {

/// What a page would fetch when it is opened: pictures, scripts, styles and frames that are not in
/// the page itself. Links to follow (<a href>) and places in the page (#name) are none.
[[nodiscard]] std::vector<std::string> external_references(const std::string& html);

}  // namespace saccade::testing
