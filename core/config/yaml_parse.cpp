#include "core/config/yaml_parse.h"

#include <yaml-cpp/yaml.h>

#include <cstddef>
#include <set>
#include <vector>

#include "core/error.h"

namespace saccade::config {
namespace {

constexpr int kMaxDepth = 64;
/// Aliases are copied, so a small text can ask for a tree of any size.
constexpr std::size_t kMaxNodes = 1'000'000;

class Builder {
 public:
  Builder(std::shared_ptr<const Source> source, bool lines)
      : source_(std::move(source)), lines_(lines) {}

  [[nodiscard]] Place place(const YAML::Mark& mark) const {
    return {source_, lines_ && !mark.is_null() ? mark.line + 1 : 0};
  }

  Node build(const YAML::Node& yaml, int depth) {
    const Place here = place(yaml.Mark());
    if (depth > kMaxDepth) throw InputError(here.text(), "nested too deeply");
    if (++nodes_ > kMaxNodes) throw InputError(here.text(), "too many values");
    Node node;
    if (yaml.IsScalar()) node = Node::scalar(yaml.Scalar(), yaml.Tag() == "!");
    if (yaml.IsSequence()) {
      node = Node::list();
      for (const YAML::Node& item : yaml) node.items.push_back(build(item, depth + 1));
    }
    if (yaml.IsMap()) node = build_map(yaml, depth);
    if (const std::string& tag = yaml.Tag(); !tag.empty() && tag != "?" && tag != "!")
      throw InputError(here.text(), "tags are not supported, found '" + tag + "'");
    node.place = here;
    return node;
  }

 private:
  Node build_map(const YAML::Node& yaml, int depth) {
    Node node = Node::map();
    std::set<std::string> seen;
    for (const auto& pair : yaml) {
      const YAML::Node& key = pair.first;
      const Place key_place = place(key.Mark());
      if (!key.IsScalar()) throw InputError(key_place.text(), "a key must be plain text");
      if (!seen.insert(key.Scalar()).second) fail_duplicate(node, key.Scalar(), key_place);
      Entry entry{key.Scalar(), key_place, build(pair.second, depth + 1), {}};
      // A value left out is marked where the parser noticed, which may be lines later.
      if (entry.value.kind == Node::Kind::kNull) entry.value.place = key_place;
      node.entries.push_back(std::move(entry));
    }
    return node;
  }

  [[noreturn]] static void fail_duplicate(const Node& map, const std::string& key,
                                          const Place& second) {
    std::string problem = "duplicate key '" + key + "'";
    const Entry* first = map.find(key);
    if (first != nullptr && first->place.line > 0)
      problem += ", first stated in line " + std::to_string(first->place.line);
    throw InputError(second.text(), problem);
  }

  std::shared_ptr<const Source> source_;
  bool lines_;
  std::size_t nodes_ = 0;
};

}  // namespace

Node parse_yaml(const std::string& text, const std::shared_ptr<const Source>& source, bool lines) {
  Builder builder(source, lines);
  try {
    const std::vector<YAML::Node> documents = YAML::LoadAll(text);
    if (documents.size() > 1)
      throw InputError(builder.place(documents[1].Mark()).text(),
                       "a second document starts here; a configuration is one document");
    return builder.build(documents.empty() ? YAML::Node() : documents[0], 0);
  } catch (const YAML::Exception& error) {
    throw InputError(builder.place(error.mark).text(), "not valid YAML: " + error.msg);
  }
}

}  // namespace saccade::config
