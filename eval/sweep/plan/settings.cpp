#include "eval/sweep/plan/settings.h"

#include <algorithm>
#include <filesystem>
#include <utility>

#include "core/config/convert.h"
#include "core/config/document.h"
#include "core/config/yaml_emit.h"
#include "core/error.h"

namespace saccade {
namespace {

namespace fs = std::filesystem;
using config::Node;

std::string value_text(Node node) {
  make_paths_absolute(node);
  return config::to_flow_yaml(node);
}

Node value_node(const std::string& yaml) {
  const config::Document document = config::parse("value: " + yaml, "a setting");
  return document.root().find("value")->value;
}

[[noreturn]] void fail(const Node& node, const std::string& name, const std::string& problem) {
  throw config::error_at(node.location, name, " ", problem);
}

}  // namespace

void make_paths_absolute(Node& node) {
  const bool is_path = node.kind == Node::Kind::kScalar &&
                       (node.text.starts_with("./") || node.text.starts_with("../"));
  if (is_path && node.location.source)
    node.text = fs::absolute(node.location.source->folder / node.text).lexically_normal().string();
  for (Node& item : node.items) make_paths_absolute(item);
  for (config::Entry& entry : node.entries) make_paths_absolute(entry.value);
}

void from_node(const Node& node, const std::string& name, Settings& settings) {
  settings.clear();
  for (const config::Entry& entry : config::entries_of(node, name))
    settings.push_back({entry.key, value_text(entry.value)});
}

Node to_node(const Settings& settings) {
  Node node = Node::map();
  for (const Setting& setting : settings)
    node.entries.push_back({setting.key, {}, value_node(setting.value), {}});
  return node;
}

void from_node(const Node& node, const std::string& name, Grid& grid) {
  grid.clear();
  for (const config::Entry& entry : config::entries_of(node, name)) {
    const std::string axis_name = name + "." + entry.key;
    GridAxis axis{entry.key, {}};
    for (const Node& item : config::items_of(entry.value, axis_name)) {
      std::string value = value_text(item);
      if (std::find(axis.values.begin(), axis.values.end(), value) != axis.values.end())
        fail(item, axis_name, "holds " + value + " twice");
      axis.values.push_back(std::move(value));
    }
    if (axis.values.empty()) fail(entry.value, axis_name, "holds no values");
    grid.push_back(std::move(axis));
  }
}

Node to_node(const Grid& grid) {
  Node node = Node::map();
  for (const GridAxis& axis : grid) {
    Node values = Node::list();
    for (const std::string& value : axis.values) values.items.push_back(value_node(value));
    node.entries.push_back({axis.key, {}, std::move(values), {}});
  }
  return node;
}

}  // namespace saccade
