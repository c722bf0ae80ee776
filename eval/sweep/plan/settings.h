#pragma once

#include <string>
#include <vector>

#include "core/config/node.h"

namespace saccade {

/// One `--set KEY.PATH=VALUE` of a job. The value is YAML on one line. Texts that begin with ./ or
/// ../ are relative to the sweep file; here they are absolute paths.
struct Setting {
  std::string key;
  std::string value;
};

/// Overrides in the order of the file: `{align.samples: 50, motion.prediction: none}`.
using Settings = std::vector<Setting>;

/// One key of the grid with its values, in the order of the file.
struct GridAxis {
  std::string key;
  std::vector<std::string> values;
};

using Grid = std::vector<GridAxis>;

/// Makes every text in a value that begins with ./ or ../ an absolute path, relative to the folder
/// of its file. Other texts are not taken for paths.
void make_paths_absolute(config::Node& value);

// In the namespace of the types, where the templates of Fields find them. InputError at the node's
// place for an axis without values or with one value twice.
void from_node(const config::Node& node, const std::string& name, Settings& settings);
[[nodiscard]] config::Node to_node(const Settings& settings);
void from_node(const config::Node& node, const std::string& name, Grid& grid);
[[nodiscard]] config::Node to_node(const Grid& grid);

}  // namespace saccade
