#pragma once

#include <string_view>

/// The page and its bundled style and script (eval/report/web), built into the library.
namespace saccade::assets {

extern const std::string_view page_html;
extern const std::string_view report_css;
extern const std::string_view report_js;

}  // namespace saccade::assets
