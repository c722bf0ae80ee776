#include "core/config/document.h"

#include <algorithm>
#include <charconv>
#include <cstdint>
#include <fstream>
#include <iterator>
#include <memory>
#include <system_error>
#include <utility>
#include <vector>

#include "core/check.h"
#include "core/config/convert.h"
#include "core/config/yaml_parse.h"
#include "core/error.h"
#include "core/io/files/input_log.h"

namespace saccade::config {
namespace {

/// Puts `over` upon `base`: maps are merged key by key, everything else is replaced, a null in
/// `over` removes the key from `base` (and stays, as a null, where `base` has no such key, so that
/// a misspelt key is still found).
void merge(Node& base, Node over);

void merge_entry(Node& base, Entry over) {
  Entry* under = base.find(over.key);
  if (under == nullptr) {
    base.entries.push_back(std::move(over));
  } else if (over.value.kind == Node::Kind::kNull) {
    base.entries.erase(base.entries.begin() + (under - base.entries.data()));
  } else {
    under->location = over.location;
    merge(under->value, std::move(over.value));
  }
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
    merge_entry(node, {key, location_, std::move(value), {}});
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

void merge(Node& base, Node over) {
  if (base.kind != Node::Kind::kMap || over.kind != Node::Kind::kMap) {
    base = std::move(over);
    return;
  }
  base.location = over.location;
  for (Entry& entry : over.entries) merge_entry(base, std::move(entry));
}

/// Applies one "key.path=value" to a tree; the value replaces what was there, a null removes it.
/// Throws InputError with the location `--set key.path`.
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

namespace fs = std::filesystem;

/// A configuration is written by people; a larger file is data given by mistake.
constexpr std::uintmax_t kMaxBytes = 16 << 20;

std::string read_text(const fs::path& file, const std::string& location) {
  std::error_code error;
  if (!fs::exists(file, error)) throw InputError(location, "no such file '" + file.string() + "'");
  if (fs::is_directory(file, error))
    throw InputError(location, "'" + file.string() + "' is a folder, expected a YAML file");
  if (const auto size = fs::file_size(file, error); !error && size > kMaxBytes)
    throw InputError(location, "'" + file.string() + "' is too large to be a configuration");
  std::ifstream stream(file, std::ios::binary);
  std::string text{std::istreambuf_iterator<char>(stream), {}};
  if (!stream.is_open() || stream.bad())
    throw InputError(location, "cannot read '" + file.string() + "'");
  InputLog::note(file.string(), std::as_bytes(std::span(text)));
  return text;
}

/// A file and what it includes, files that include each other excluded.
class Loader {
 public:
  Node load(const fs::path& file, const SourceLocation& stated_at) {
    const std::string location = stated_at.source ? stated_at.text() : file.string();
    std::error_code error;
    const fs::path identity = fs::weakly_canonical(file, error);
    if (std::find(open_.begin(), open_.end(), identity) != open_.end())
      throw InputError(location, "include cycle: '" + file.string() + "' includes itself");
    open_.push_back(identity);
    Node root = parse(read_text(file, location), file.string(), file.parent_path());
    open_.pop_back();
    return root;
  }

  Node parse(std::string_view text, const std::string& name, const fs::path& folder) {
    const auto source = std::make_shared<const Source>(Source{name, folder});
    Node stated = parse_yaml(text, source);
    if (stated.kind == Node::Kind::kNull) stated = empty_map(stated.location);
    require_map(stated);
    Node root = empty_map(stated.location);
    if (Entry* include = stated.find("include")) {
      for (const auto& [file, location] : included_files(include->value))
        merge(root, load(file, location));
      stated.entries.erase(stated.entries.begin() + (include - stated.entries.data()));
    }
    merge(root, std::move(stated));
    return root;
  }

 private:
  static Node empty_map(const SourceLocation& location) {
    Node node = Node::map();
    node.location = location;
    return node;
  }

  static void require_map(const Node& root) {
    if (root.kind == Node::Kind::kMap) return;
    const bool no_space =
        root.kind == Node::Kind::kScalar && root.text.find(':') != std::string::npos;
    throw InputError(root.location.text(), "expected 'key: value' lines, got " + root.shown() +
                                               (no_space ? "; a space must follow ':'" : ""));
  }

  static std::vector<std::pair<fs::path, SourceLocation>> included_files(const Node& include) {
    const bool single = include.kind != Node::Kind::kList;
    std::vector<std::pair<fs::path, SourceLocation>> files;
    for (const Node& item : single ? std::vector{include} : include.items)
      from_node(item, "include", files.emplace_back(fs::path(), item.location).first);
    return files;
  }

  std::vector<fs::path> open_;
};

Document with_overrides(Node root, std::span<const std::string> overrides) {
  for (const std::string& assignment : overrides) apply_override(root, assignment);
  return Document(std::move(root));
}

}  // namespace

Document::Document(Node root) : root_(std::move(root)) {
  SACCADE_CHECK(root_.kind == Node::Kind::kMap);
}

Document Document::empty(std::span<const std::string> overrides) {
  Node root = Node::map();
  root.location.source = std::make_shared<const Source>(Source{"configuration", {}});
  return with_overrides(std::move(root), overrides);
}

Document load(const fs::path& file, std::span<const std::string> overrides) {
  return with_overrides(Loader().load(file, {}), overrides);
}

Document parse(std::string_view yaml, const std::string& name, const fs::path& folder,
               std::span<const std::string> overrides) {
  return with_overrides(Loader().parse(yaml, name, folder), overrides);
}

}  // namespace saccade::config
