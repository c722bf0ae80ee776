#pragma once

#include <memory>
#include <span>
#include <string>
#include <string_view>

#include "core/check.h"
#include "core/config/fields.h"

namespace saccade::config {

/// One row of a module's table of methods, the one way in which depth, reconstruction, tracking and
/// refinement choose theirs. A new method is a row and a pair of files:
///   constexpr DepthMethodRow kDepthMethods[] = {
///       {.name = "rays",
///        .help = "Edge points of a space sweep, each refined by a regression.",
///        .describe = describe_rays,
///        .make = make_rays},
///   };
/// (estimator/depth/depth_config.cpp).
template <class Config, class Method, class... Inputs>
struct MethodRow {
  std::string_view name;  ///< value of the key, and name of the section that holds its options
  std::string_view help;  ///< a sentence: the section's text in the reference
  void (*describe)(Fields&, Config&);
  std::unique_ptr<Method> (*make)(const Config&, Inputs...);
};

/// The row of this name, which describe_method() read.
template <class Row>
[[nodiscard]] const Row& find_method(std::span<const Row> rows, std::string_view name) {
  for (const Row& row : rows)
    if (row.name == name) return row;
  SACCADE_CHECK(false);
  return rows.front();
}

/// `help`, then the name and help of every row: the text of the key that chooses among them.
template <class Rows>
[[nodiscard]] std::string with_methods(std::string_view help, const Rows& rows) {
  std::string text(help);
  for (const auto& row : rows) text.append(" ").append(row.name).append(": ").append(row.help);
  return text;
}

/// Describes `key`, whose value is the name of one of the rows, and the section of that row alone:
/// keys of other methods are errors that say to which method they belong. `help` is what the methods
/// have in common; those of the rows are appended.
template <class Row, class Config>
void describe_method(Fields& fields, std::string_view key, std::string& name,
                     std::span<const Row> rows, Config& config, std::string_view help) {
  Names<std::string> names;
  for (const Row& row : rows) names.emplace_back(row.name, std::string(row.name));
  fields.choice(key, name, names, with_methods(help, rows));
  const Row& row = find_method(rows, name);
  if (row.describe == nullptr) return;
  fields.group(
      row.name, [&](Fields& section) { row.describe(section, config); }, row.help);
}

}  // namespace saccade::config
