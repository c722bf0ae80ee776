#include "core/config/merge.h"

#include <algorithm>
#include <charconv>
#include <memory>
#include <string_view>
#include <unordered_map>
#include <utility>
#include <vector>

#include "core/config/yaml_parse.h"
#include "core/error.h"

namespace saccade::config {
namespace {

/// The keys of `over` are each there once. A large map is no reason to compare all keys with all.
void merge_entries(Node& base, std::vector<Entry> over) {
  std::unordered_map<std::string, std::size_t> places;
  for (std::size_t i = 0; i < base.entries.size(); ++i) places.emplace(base.entries[i].key, i);
  std::vector<bool> is_removed(base.entries.size(), false);
  for (Entry& entry : over) {
    const auto under = places.find(entry.key);
    if (under == places.end()) {
      base.entries.push_back(std::move(entry));
    } else if (entry.value.kind == Node::Kind::kNull) {
      is_removed[under->second] = true;
    } else {
      base.entries[under->second].location = entry.location;
      merge(base.entries[under->second].value, std::move(entry.value));
    }
  }
  std::vector<Entry> kept;
  kept.reserve(base.entries.size());
  for (std::size_t i = 0; i < base.entries.size(); ++i)
    if (i >= is_removed.size() || !is_removed[i]) kept.push_back(std::move(base.entries[i]));
  base.entries = std::move(kept);
}

/// Walks one "key.path" into a tree, making the maps that are missing.
class Override {
 public:
  Override(const std::string& path, SourceLocation location)
      : path_(path), location_(std::move(location)) {}

  void apply(Node& root, Node value) {
    Node* node = &root;
    for (std::string key = next_key(); !at_end(); key = next_key()) node = &step(*node, key);
    set(*node, last_key_, std::move(value));
  }

 private:
  [[nodiscard]] bool at_end() const { return begin_ > path_.size(); }

  std::string next_key() {
    const std::size_t dot = std::min(path_.find('.', begin_), path_.size());
    last_key_ = path_.substr(begin_, dot - begin_);
    if (last_key_.empty()) fail("an empty key in '" + path_ + "'");
    begin_ = dot + 1;
    return last_key_;
  }

  Node& step(Node& node, const std::string& key) {
    if (node.kind == Node::Kind::kList) return item(node, key);
    if (node.kind == Node::Kind::kNull) make_map(node);
    require_map(node, key);
    if (Entry* entry = node.find(key)) return entry->value;
    node.entries.push_back({key, location_, Node::map(), {}});
    node.entries.back().value.location = location_;
    return node.entries.back().value;
  }

  void set(Node& node, const std::string& key, Node value) {
    if (node.kind == Node::Kind::kList) {
      item(node, key) = std::move(value);
      return;
    }
    if (node.kind == Node::Kind::kNull) make_map(node);
    require_map(node, key);
    Entry* entry = node.find(key);
    // A map given here replaces the one before: its keys may belong to another choice.
    if (entry != nullptr && value.kind == Node::Kind::kMap) entry->value = Node{};
    merge_entries(node, {Entry{key, location_, std::move(value), {}}});
  }

  Node& item(Node& list, const std::string& key) const {
    std::size_t index = 0;
    const auto [end, error] = std::from_chars(key.data(), key.data() + key.size(), index);
    if (error != std::errc() || end != key.data() + key.size())
      fail("'" + key + "' is no list index (" + list.location.text() + " is a list)");
    if (index >= list.items.size())
      fail("there is no item " + key + ", the list of " + list.location.text() + " has " +
           std::to_string(list.items.size()) + " (counted from 0)");
    return list.items[index];
  }

  void make_map(Node& node) const {
    node = Node::map();
    node.location = location_;
  }

  void require_map(const Node& node, const std::string& key) const {
    if (node.kind == Node::Kind::kMap) return;
    fail("cannot set '" + key + "' in " + node.shown() + " (" + node.location.text() + ")");
  }

  [[noreturn]] void fail(const std::string& problem) const {
    throw InputError(location_.text(), problem);
  }

  std::string path_;
  SourceLocation location_;
  std::size_t begin_ = 0;
  std::string last_key_;
};

}  // namespace

void merge(Node& base, Node over) {
  if (base.kind != Node::Kind::kMap || over.kind != Node::Kind::kMap) {
    base = std::move(over);
    return;
  }
  base.location = over.location;
  merge_entries(base, std::move(over.entries));
}

void apply_override(Node& root, const std::string& assignment) {
  const std::size_t equals = assignment.find('=');
  if (equals == std::string::npos || equals == 0)
    throw InputError("--set " + assignment, "expected key.path=value");
  const std::string path = assignment.substr(0, equals);
  const auto source = std::make_shared<const Source>(Source{"--set " + path, {}});
  if (assignment.find_first_not_of(" \t\n", equals + 1) == std::string::npos)
    throw InputError(source->name,
                     "no value behind '=' (write '' for empty text, ~ for the default)");
  Override(path, {source, 0})
      .apply(root, parse_yaml(std::string_view(assignment).substr(equals + 1), source, false));
}

}  // namespace saccade::config
