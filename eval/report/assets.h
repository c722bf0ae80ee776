#pragma once

#include <string_view>

/// Files that are built into the library: the page and its bundled style and script
/// (eval/report/web), and the numbers of the thesis (eval/report/reference).
namespace saccade::assets {

extern const std::string_view page_html;
extern const std::string_view report_css;
extern const std::string_view report_js;
extern const std::string_view thesis_yaml;

}  // namespace saccade::assets
