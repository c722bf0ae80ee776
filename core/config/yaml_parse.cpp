#include "core/config/yaml_parse.h"

#include <yaml-cpp/anchor.h>
#include <yaml-cpp/eventhandler.h>
#include <yaml-cpp/exceptions.h>
#include <yaml-cpp/mark.h>
#include <yaml-cpp/parser.h>

#include <cstddef>
#include <map>
#include <sstream>
#include <utility>
#include <vector>

#include "core/config/yaml_text.h"
#include "core/error.h"

namespace saccade::config {
namespace {

constexpr std::size_t kMaxDepth = 64;
/// Aliases are copied, so a small text can ask for a tree of any size.
constexpr std::size_t kMaxNodes = 1'000'000;

/// Builds the tree from the parser's events. (YAML::Node would hide duplicate keys and further
/// documents, and YAML::LoadAll of yaml-cpp 0.7 never returns from a stray comma.)
class Builder final : public YAML::EventHandler {
 public:
  Builder(std::string_view text, std::shared_ptr<const Source> source, bool lines)
      : text_(text), source_(std::move(source)), lines_(lines) {}

  [[nodiscard]] SourceLocation location(const YAML::Mark& mark) const {
    return {source_, lines_ && !mark.is_null() ? mark.line + 1 : 0};
  }

  Node take() { return std::move(root_); }

  void OnDocumentStart(const YAML::Mark& mark) override {
    if (++documents_ > 1)
      fail(mark, "the document has ended before this; a configuration is one document");
  }
  void OnDocumentEnd() override {}

  void OnNull(const YAML::Mark& mark, YAML::anchor_t anchor) override {
    add(mark, anchor, Node{}, 1);
  }

  void OnScalar(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor,
                const std::string& value) override {
    const bool quoted = tag == "!";
    if (quoted && !is_closed_quote(text_, static_cast<std::size_t>(mark.pos)))
      fail(mark, "not valid YAML: a quote opens here and is never closed");
    refuse_tag(mark, tag);
    add(mark, anchor, Node::scalar(value, quoted), 1);
  }

  void OnAlias(const YAML::Mark& mark, YAML::anchor_t anchor) override {
    const auto found = anchored_.find(anchor);
    if (found == anchored_.end()) fail(mark, "an alias inside of what it names");
    add(mark, 0, found->second.node, found->second.count);
  }

  void OnSequenceStart(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor,
                       YAML::EmitterStyle::value /*style*/) override {
    refuse_tag(mark, tag);
    open(mark, anchor, Node::list());
  }
  void OnSequenceEnd() override { close(); }

  void OnMapStart(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor,
                  YAML::EmitterStyle::value /*style*/) override {
    refuse_tag(mark, tag);
    open(mark, anchor, Node::map());
  }
  void OnMapEnd() override { close(); }

 private:
  /// A list or map whose end has not come yet.
  struct Open {
    Node node;
    YAML::Mark mark;
    YAML::anchor_t anchor = 0;
    std::size_t first_node = 0;       ///< count of nodes before it
    bool has_key = false;             ///< of a map: a key stands, its value comes next
    std::map<std::string, int> keys;  ///< of a map: the line of each key so far
  };
  struct Anchored {
    Node node;
    std::size_t count = 1;
  };

  void open(const YAML::Mark& mark, YAML::anchor_t anchor, Node node) {
    if (open_.size() >= kMaxDepth) fail(mark, "nested too deeply");
    node.location = location(mark);
    open_.push_back({std::move(node), mark, anchor, nodes_++, false, {}});
  }

  void close() {
    Open done = std::move(open_.back());
    open_.pop_back();
    put(done.mark, done.anchor, std::move(done.node), nodes_ - done.first_node);
  }

  void add(const YAML::Mark& mark, YAML::anchor_t anchor, Node node, std::size_t count) {
    if (node.location.line == 0) node.location = location(mark);
    nodes_ += count;
    put(mark, anchor, std::move(node), count);
  }

  /// Puts a finished value of `count` nodes where it belongs.
  void put(const YAML::Mark& mark, YAML::anchor_t anchor, Node node, std::size_t count) {
    if (anchor != 0) anchored_[anchor] = {node, count};
    if (anchor != 0) anchored_nodes_ += count;
    if (nodes_ + anchored_nodes_ > kMaxNodes) fail(mark, "too many values");
    if (open_.empty()) {
      root_ = std::move(node);
    } else if (open_.back().node.kind == Node::Kind::kList) {
      open_.back().node.items.push_back(std::move(node));
    } else if (!open_.back().has_key) {
      put_key(open_.back(), mark, node);
    } else {
      Entry& entry = open_.back().node.entries.back();
      // A value left out is marked where the parser noticed, which may be lines later.
      if (node.kind == Node::Kind::kNull) node.location = entry.location;
      entry.value = std::move(node);
      open_.back().has_key = false;
    }
  }

  void put_key(Open& map, const YAML::Mark& mark, const Node& key) const {
    if (key.kind != Node::Kind::kScalar) fail(mark, "a key must be plain text");
    const auto [first, is_new] = map.keys.emplace(key.text, location(mark).line);
    if (!is_new) {
      const std::string where =
          lines_ ? ", first stated in line " + std::to_string(first->second) : "";
      fail(mark, "duplicate key '" + key.text + "'" + where);
    }
    map.node.entries.push_back({key.text, location(mark), {}, {}});
    map.has_key = true;
  }

  void refuse_tag(const YAML::Mark& mark, const std::string& tag) const {
    if (!tag.empty() && tag != "?" && tag != "!")
      fail(mark, "tags are not supported, found '" + tag + "'");
  }

  [[noreturn]] void fail(const YAML::Mark& mark, const std::string& problem) const {
    throw InputError(location(mark).text(), problem);
  }

  std::string_view text_;
  std::shared_ptr<const Source> source_;
  bool lines_;
  int documents_ = 0;
  std::size_t nodes_ = 0;           ///< in the tree so far
  std::size_t anchored_nodes_ = 0;  ///< in the copies kept for aliases
  std::vector<Open> open_;
  std::map<YAML::anchor_t, Anchored> anchored_;
  Node root_;
};

}  // namespace

Node parse_yaml(std::string_view text, const std::shared_ptr<const Source>& source, bool lines) {
  constexpr std::string_view kByteOrderMark = "\xef\xbb\xbf";
  if (text.starts_with(kByteOrderMark)) text.remove_prefix(kByteOrderMark.size());
  if (const auto line = line_of_control_character(text))
    throw InputError(SourceLocation{source, lines ? *line : 0}.text(), "not a text file");
  Builder builder(text, source, lines);
  std::istringstream stream{std::string(text)};
  try {
    YAML::Parser parser(stream);
    // The second call finds what stands behind the document; it must not be asked for more.
    if (parser.HandleNextDocument(builder)) parser.HandleNextDocument(builder);
  } catch (const YAML::Exception& error) {
    throw InputError(builder.location(error.mark).text(), "not valid YAML: " + error.msg);
  }
  return builder.take();
}

}  // namespace saccade::config
