#include "core/config/document.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <fstream>
#include <iterator>
#include <memory>
#include <utility>
#include <vector>

#include "core/check.h"
#include "core/config/convert.h"
#include "core/config/merge.h"
#include "core/config/shipped.h"
#include "core/config/yaml_parse.h"
#include "core/error.h"
#include "core/io/files/input_log.h"

namespace saccade::config {
namespace {

namespace fs = std::filesystem;

/// A configuration is written by people; a larger file is data given by mistake.
constexpr std::uintmax_t kMaxBytes = 16 << 20;
/// Files that include two others each are read as often as a power of two says.
constexpr std::size_t kMaxIncludeDepth = 32;
constexpr std::size_t kMaxFiles = 256;

std::string read_text(const fs::path& file, const std::string& location) {
  std::error_code error;
  if (!fs::exists(file, error))
    throw InputError(location, "no such file '" + file.string() + "'" + nearest_shipped(file));
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
    if (open_.size() == kMaxIncludeDepth)
      throw InputError(location, "'" + file.string() + "' is the " +
                                     std::to_string(kMaxIncludeDepth + 1) +
                                     "th file of a chain of includes");
    if (++files_ > kMaxFiles)
      throw InputError(location, "includes more than " + std::to_string(kMaxFiles) +
                                     " files, one file as often as it is named");
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
  std::size_t files_ = 0;
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
  return with_overrides(Loader().load(find_configuration(file), {}), overrides);
}

Document parse(std::string_view yaml, const std::string& name, const fs::path& folder,
               std::span<const std::string> overrides) {
  return with_overrides(Loader().parse(yaml, name, folder), overrides);
}

}  // namespace saccade::config
