#pragma once

#include <string>
#include <vector>

#include "eval/report/charts/page_chart.h"

namespace saccade {

/// A page in the look of the report.
struct Page {
  std::string title;                            ///< plain text
  std::string summary;                          ///< HTML, below the title
  std::string contents;                         ///< HTML: links to the parts of the page
  std::string body;                             ///< HTML
  std::vector<PageChart> charts = {};           ///< those whose boxes the body has
  std::string definitions = "docs/metrics.md";  ///< the document that the page's foot names
  /// Address of the folder with the files of page_assets(), relative to the page; empty: the page
  /// holds them itself and needs nothing beside it.
  std::string assets = {};
};

[[nodiscard]] std::string page_text(const Page& page);

/// A file that pages with `assets` share. Its name changes with its contents, so that old pages keep
/// what they were written with.
struct PageAsset {
  std::string name;
  std::string_view text;
};
[[nodiscard]] std::vector<PageAsset> page_assets();

}  // namespace saccade
