#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include "core/config/convert.h"
#include "core/config/former_keys.h"
#include "core/config/node.h"
#include "core/config/reference.h"
#include "core/config/rule.h"
#include "core/config/type_name.h"

namespace saccade::config {

/// Names of the values of an enum: {{"dense", Selection::kDense}, ...}.
template <class E>
using Names = std::vector<std::pair<std::string, E>>;

/// What the input gives for a key.
enum class Form { kAbsent, kNumber, kText, kList, kMap };

/// The keys of one section while they are read, printed or checked. An options struct names its
/// keys once,
///   void describe(config::Fields& fields, AlignOptions& options) {
///     fields.value("samples", options.samples, "Map points drawn per iteration.").range(6, 1e6);
///     fields.section("blur", options.blur, "Blur of the template.");
///   }
/// in the struct's own namespace; every use (read, print, check, reference of config.h) runs this
/// function. Help texts are sentences: they are the only text that a key has.
/// The value the struct holds before is the default. describe() may branch on what it read before:
/// keys of the branch not taken are then unknown, and the error says for which choice they would be
/// valid.
class Fields {
 public:
  /// bool, int, int64, uint64, float, double (finite), std::string, std::filesystem::path (relative
  /// to the file that states it), fixed (std::array, Eigen vectors) and variable (std::vector)
  /// lists, std::map<std::string, T>, and std::optional of these (`~` is nullopt).
  template <class T>
  Rule value(std::string_view key, T& target, std::string_view help);

  /// An enum by name.
  template <class E>
  Rule choice(std::string_view key, E& target, const Names<std::type_identity_t<E>>& names,
              std::string_view help);

  /// A path; the same as value(), for the eye.
  template <class Path>
  Rule path(std::string_view key, Path& target, std::string_view help) {
    return value(key, target, help);
  }

  /// A configuration that must exist, as std::filesystem::path or an optional of it: a file relative
  /// to the one that states it, else a shipped one by its name (find_shipped()).
  template <class Path>
  Rule configuration(std::string_view key, Path& target, std::string_view help) {
    Rule rule = value(key, target, help);
    if (const auto found = stated_configuration(key)) target = *found;
    return rule;
  }

  /// A struct with its own describe(). Absent: its defaults.
  template <class T>
  Rule section(std::string_view key, T& target, std::string_view help);

  /// A section that is there or not (absent or `~`: keeps what it holds, nullopt).
  template <class T>
  Rule section(std::string_view key, std::optional<T>& target, std::string_view help);

  /// A section whose keys belong to the same struct: `describe_group(Fields&)` names them.
  Rule group(std::string_view key, const std::function<void(Fields&)>& describe_group,
             std::string_view help);

  /// A list of sections; a stated list replaces the default one, and `item` holds the defaults of
  /// its items.
  template <class T>
  Rule list(std::string_view key, std::vector<T>& target, std::string_view help,
            const std::type_identity_t<T>& item = {});

  /// A subtree of which only the YAML text is kept, unchecked (a resolved configuration inside
  /// dataset.yaml).
  Rule embed(std::string_view key, std::string& yaml, std::string_view help);

  /// A condition between several keys, reported at `key`: expect(near < far, "near_m", "must be
  /// below far_m").
  void expect(bool holds, std::string_view key, std::string_view problem);

  /// Lets keys pass that nobody described: only for files that other programs write.
  void allow_unknown() { unknown_allowed_ = true; }

  /// True while values come in, false while a struct is printed or checked. A preset that changes
  /// other keys' defaults must be applied only while reading.
  [[nodiscard]] bool reading() const { return mode_ != Mode::kPrint && mode_ != Mode::kCheck; }
  /// Whether the input states this key; false unless reading.
  [[nodiscard]] bool has(std::string_view key) const { return form(key) != Form::kAbsent; }
  /// Whether the number at a key is 0, for a describe() that branches on it: the reference tries both.
  [[nodiscard]] bool is_zero(std::string_view key, double value);
  /// What the input gives for a key that takes several forms; kAbsent unless reading.
  [[nodiscard]] Form form(std::string_view key) const;

 private:
  friend class Rule;
  friend class Session;
  using Describe = std::function<void(Fields&)>;
  enum class Mode { kRead, kPrint, kCheck, kProbe, kReference };
  struct Choice {
    std::string key;
    std::vector<std::string> names;
    std::size_t taken = 0;
  };

  Fields(Mode mode, std::string path, const Node* input, SourceLocation location);

  [[nodiscard]] bool writing() const { return mode_ == Mode::kPrint || mode_ == Mode::kCheck; }
  /// The file that a stated key of configuration() means; nullopt where the input does not state it.
  [[nodiscard]] std::optional<std::filesystem::path> stated_configuration(
      std::string_view key) const;

  /// The dotted path of a key.
  [[nodiscard]] std::string name_of(std::string_view key) const;
  /// What the input holds at a key; nullptr when absent or not reading.
  [[nodiscard]] const Node* input_at(std::string_view key) const;
  /// Makes the key known; its input when values are to be taken from it, else nullptr.
  const Node* declare(std::string_view key);
  /// Adds to the output; the value that rules must check, if any.
  const Node* put(std::string_view key, Node value, std::string_view help);
  /// Adds a key to the reference; does nothing unless that is what is made.
  void record(std::string_view key, const std::string& type, const Node& initial,
              std::string_view help);
  /// The value of a switch: of the reference, which tries both, else `current`.
  [[nodiscard]] bool explored(std::string_view key, bool current);
  void note(const std::string& name, const std::string& text);
  void require(const std::string& name);

  std::size_t choose(std::string_view key, const std::vector<std::string>& names,
                     std::size_t current, std::string_view help);
  Rule each(std::string_view key, std::size_t size, const std::function<void(std::size_t)>& resize,
            const std::function<void(Fields&, std::size_t)>& describe_item, std::string_view help);
  /// Describes the map of a child: reads `input` (nullptr: absent), or returns the child's output.
  Node child(const std::string& name, const Node* input, const Describe& describe_child) const;

  /// Reports keys that nobody described, then keys that are missing.
  void finish(const Describe& describe_this);
  [[noreturn]] void fail_unknown(const Entry& entry, const Describe& describe_this) const;
  /// Throws where the key of this name, or one in the map that it holds, is a former one.
  void fail_former(const Entry& entry, const std::string& name) const;
  /// "source: file (it belongs to source: circle)" when another choice makes the key valid, else
  /// "".
  [[nodiscard]] std::string choice_that_knows(const std::string& key,
                                              const Describe& describe_this) const;
  [[noreturn]] void fail(const Node& at, const std::string& name, const std::string& separator,
                         const std::string& problem) const;

  Mode mode_;
  std::string path_;         ///< dotted keys from the root; "" at the root
  const Node* input_;        ///< the map that is read; nullptr when absent
  SourceLocation location_;  ///< of the map, or of the nearest one around it that exists
  Node output_ = Node::map();
  std::vector<std::string> keys_;     ///< described so far
  std::vector<std::string> missing_;  ///< required and not stated
  std::vector<Choice> choices_;
  const Choice* probed_ = nullptr;  ///< the choice that a probe pretends to read
  bool unknown_allowed_ = false;
  std::span<const FormerKey> former_keys_;  ///< answers to unknown keys
  ReferenceRecord* reference_ = nullptr;    ///< what kReference fills
};

template <class T>
Rule Fields::value(std::string_view key, T& target, std::string_view help) {
  const Node* node = declare(key);
  if (node != nullptr) from_node(*node, name_of(key), target);
  if (mode_ == Mode::kReference) record(key, type_name(&target), to_node(target), help);
  if constexpr (std::is_same_v<T, bool>) target = explored(key, target);
  if (writing()) node = put(key, to_node(target), help);
  if (mode_ == Mode::kCheck) {
    T as_read = target;
    from_node(*node, name_of(key), as_read);  // what no file could state: NaN, infinity
  }
  return {*this, name_of(key), node};
}

template <class E>
Rule Fields::choice(std::string_view key, E& target, const Names<std::type_identity_t<E>>& names,
                    std::string_view help) {
  std::vector<std::string> texts;
  std::size_t current = names.size();
  for (const auto& [text, meaning] : names) {
    if (meaning == target) current = texts.size();
    texts.push_back(text);
  }
  target = names[choose(key, texts, current, help)].second;
  return {*this, name_of(key), nullptr};
}

template <class T>
Rule Fields::section(std::string_view key, T& target, std::string_view help) {
  return group(
      key, [&](Fields& fields) { describe(fields, target); }, help);
}

template <class T>
Rule Fields::section(std::string_view key, std::optional<T>& target, std::string_view help) {
  const Node* stated = input_at(key);
  if (stated != nullptr && stated->kind == Node::Kind::kNull) target.reset();
  if (stated != nullptr && stated->kind != Node::Kind::kNull && !target) target = T{};
  if (mode_ == Mode::kReference) {
    T described = target.value_or(T{});
    return section(key, described, help);
  }
  if (target) return section(key, *target, help);
  declare(key);
  if (writing()) put(key, Node{}, help);
  return {*this, name_of(key), nullptr};
}

template <class T>
Rule Fields::list(std::string_view key, std::vector<T>& target, std::string_view help,
                  const std::type_identity_t<T>& item) {
  const auto resize = [&](std::size_t size) { target.assign(size, item); };
  const auto describe_item = [&](Fields& fields, std::size_t i) { describe(fields, target[i]); };
  return each(key, target.size(), resize, describe_item, help);
}

}  // namespace saccade::config
