#pragma once

#include <cstddef>
#include <functional>
#include <map>
#include <set>
#include <string>
#include <vector>

namespace saccade::config {

enum class Form;

/// One key of a configuration as the reference shows it.
struct ReferenceKey {
  std::string name;     ///< dotted from the root; of the items of a list "meshes[].file"
  std::string type;     ///< "number", "list of 3 numbers", "choice", "section"
  std::string initial;  ///< the default as YAML; of a section ""
  std::vector<std::string> other_initials = {};  ///< "`12` with `method: equations`"
  std::string rule = {};                         ///< "0 to 100"; "" where every value is allowed
  std::string help;
  std::vector<std::string> conditions = {};  ///< "`method: rays`"; the key exists where all hold
};

/// What one run of a description declares while some choices are held at a value.
struct ReferenceRecord {
  /// A choice that the description asked for: of an enum, a switch, or the form of a key.
  struct Choice {
    std::string name;
    std::vector<std::string> values;
  };

  std::map<std::string, std::size_t> held;  ///< value of a choice, in place of its default
  std::vector<ReferenceKey> keys;
  std::vector<Choice> choices;
  std::set<std::string> of_any_form;  ///< keys whose form was asked for

  /// Notes a choice; the value that is held, else `current`.
  std::size_t take(const std::string& name, const std::vector<std::string>& values,
                   std::size_t current);
  /// A choice that is held counts as stated: a preset sets the defaults of other keys only then.
  [[nodiscard]] Form form(const std::string& name);
  void add_rule(const std::string& name, const std::string& rule);
};

/// All keys that `describe` can declare, in its order, those of choices that are not taken by
/// default included, with the defaults that each choice gives them. Every choice is tried with all its values while the others stay as they are;
/// keys that need two choices at once are found where the second choice appears with the first.
[[nodiscard]] std::vector<ReferenceKey> explore_keys(
    const std::function<void(ReferenceRecord&)>& describe);

/// One Markdown table of the keys of each section, the keys of the root first.
[[nodiscard]] std::string to_markdown(const std::vector<ReferenceKey>& keys);

}  // namespace saccade::config
