#include "core/config/fields.h"

#include <algorithm>

#include "core/check.h"
#include "core/config/document.h"
#include "core/config/shipped.h"
#include "core/config/suggest.h"
#include "core/config/yaml_emit.h"
#include "core/error.h"

namespace saccade::config {

Fields::Fields(Mode mode, std::string path, const Node* input, SourceLocation location)
    : mode_(mode), path_(std::move(path)), input_(input), location_(std::move(location)) {}

std::string Fields::name_of(std::string_view key) const {
  return path_.empty() ? std::string(key) : path_ + "." + std::string(key);
}

const Node* Fields::input_at(std::string_view key) const {
  const Entry* entry = input_ != nullptr && reading() ? input_->find(key) : nullptr;
  return entry != nullptr ? &entry->value : nullptr;
}

const Node* Fields::declare(std::string_view key) {
  SACCADE_CHECK(std::find(keys_.begin(), keys_.end(), key) == keys_.end());
  keys_.emplace_back(key);
  return mode_ == Mode::kRead ? input_at(key) : nullptr;
}

const Node* Fields::put(std::string_view key, Node value, std::string_view help) {
  output_.entries.push_back({std::string(key), {}, std::move(value), std::string(help)});
  return mode_ == Mode::kCheck ? &output_.entries.back().value : nullptr;
}

void Fields::note(const std::string& name, const std::string& text) {
  if (reference_ != nullptr) reference_->add_rule(name, text);
  if (!writing()) return;
  Entry* entry = output_.find(std::string_view(name).substr(path_.empty() ? 0 : path_.size() + 1));
  if (entry != nullptr) entry->rules += (entry->rules.empty() ? "" : ", ") + text;
}

void Fields::record(std::string_view key, const std::string& type, const Node& initial,
                    std::string_view help) {
  if (reference_ == nullptr) return;
  const std::string shown = initial.kind == Node::Kind::kMap ? "" : to_flow_yaml(initial);
  reference_->keys.push_back(
      {.name = name_of(key), .type = type, .initial = shown, .help = std::string(help)});
}

bool Fields::explored(std::string_view key, bool current) {
  if (reference_ == nullptr) return current;
  return reference_->take(name_of(key), {"false", "true"}, current ? 1 : 0) == 1;
}

bool Fields::is_zero(std::string_view key, double value) {
  if (reference_ == nullptr) return value == 0;
  return reference_->take(name_of(key), {"above 0", "0"}, value == 0 ? 1 : 0) == 1;
}

std::optional<std::filesystem::path> Fields::stated_configuration(std::string_view key) const {
  const Node* node = mode_ == Mode::kRead ? input_at(key) : nullptr;
  if (node == nullptr || node->kind != Node::Kind::kScalar || node->text.empty())
    return std::nullopt;
  std::filesystem::path file;
  from_node(*node, name_of(key), file);
  std::error_code error;
  if (std::filesystem::is_regular_file(file, error)) return file;
  try {
    if (const auto shipped = find_shipped(node->text)) return shipped;
  } catch (const InputError& several) {
    fail(*node, name_of(key), ": ", several.what());
  }
  fail(*node, name_of(key), ": ",
       "no such file '" + file.string() + "', and no shipped configuration of this name" +
           nearest_shipped(node->text));
}

void Fields::require(const std::string& name) {
  const auto key = std::string_view(name).substr(path_.empty() ? 0 : path_.size() + 1);
  if (mode_ == Mode::kRead && input_at(key) == nullptr) missing_.push_back(name);
}

Form Fields::form(std::string_view key) const {
  if (reference_ != nullptr) return reference_->form(name_of(key));
  const Node* node = input_at(key);
  if (node == nullptr) return Form::kAbsent;
  switch (node->kind) {
    case Node::Kind::kNull:
      return Form::kAbsent;
    case Node::Kind::kScalar:
      return number_of(*node) ? Form::kNumber : Form::kText;
    case Node::Kind::kList:
      return Form::kList;
    case Node::Kind::kMap:
      return Form::kMap;
  }
  return Form::kAbsent;
}

std::size_t Fields::choose(std::string_view key, const std::vector<std::string>& names,
                           std::size_t current, std::string_view help) {
  SACCADE_CHECK(current < names.size());
  if (const Node* node = declare(key)) {
    std::string text;
    from_node(*node, name_of(key), text);
    const auto found = std::find(names.begin(), names.end(), text);
    const auto former_value = explain_former_key(name_of(key) + "=" + text, former_keys_);
    if (found == names.end())
      fail(*node, name_of(key), ": ",
           former_value.value_or("unknown value '" + text + "'; " +
                                 suggestion(text, names, "values")));
    current = static_cast<std::size_t>(found - names.begin());
  }
  if (mode_ == Mode::kProbe && probed_ != nullptr && probed_->key == key) current = probed_->taken;
  record(key, "choice", Node::scalar(names[current], true), help);
  if (reference_ != nullptr) current = reference_->take(name_of(key), names, current);
  if (writing()) put(key, Node::scalar(names[current], true), help);
  note(name_of(key), joined(names));
  choices_.push_back({std::string(key), names, current});
  return current;
}

Rule Fields::group(std::string_view key, const Describe& describe_group, std::string_view help) {
  const Node* node = declare(key);
  if (node != nullptr && node->kind == Node::Kind::kNull) node = nullptr;
  record(key, "section", Node::map(), help);
  if (mode_ != Mode::kProbe) {
    Node output = child(name_of(key), node, describe_group);
    if (writing()) put(key, std::move(output), help);
  }
  return {*this, name_of(key), nullptr};
}

Rule Fields::each(std::string_view key, std::size_t size,
                  const std::function<void(std::size_t)>& resize,
                  const std::function<void(Fields&, std::size_t)>& describe_item,
                  std::string_view help) {
  const std::string name = name_of(key);
  const Node* node = declare(key);
  if (mode_ == Mode::kReference) {
    record(key, "list of sections", Node::list(), help);
    resize(1);
    child(name + "[]", nullptr, [&](Fields& fields) { describe_item(fields, 0); });
    resize(0);
    return {*this, name, nullptr};
  }
  if (node != nullptr) resize(size = items_of(*node, name).size());
  Node output = Node::list();
  for (std::size_t i = 0; i < size && (node != nullptr || writing()); ++i)
    output.items.push_back(child(item_name(name, i), node != nullptr ? &node->items[i] : nullptr,
                                 [&](Fields& fields) { describe_item(fields, i); }));
  if (writing()) node = put(key, std::move(output), help);
  return {*this, name, node};
}

Rule Fields::embed(std::string_view key, std::string& yaml, std::string_view help) {
  if (const Node* node = declare(key)) {
    static_cast<void>(entries_of(*node, name_of(key)));
    yaml = to_yaml(*node);
  }
  record(key, "map", Node::map(), help);
  if (writing()) put(key, parse(yaml, name_of(key)).root(), help);
  return {*this, name_of(key), nullptr};
}

void Fields::expect(bool holds, std::string_view key, std::string_view problem) {
  if (holds || (mode_ != Mode::kRead && mode_ != Mode::kCheck)) return;
  const Node* node = input_at(key);
  Node section;
  section.location = location_;
  fail(node != nullptr ? *node : section, name_of(key), " ", std::string(problem));
}

Node Fields::child(const std::string& name, const Node* input,
                   const Describe& describe_child) const {
  if (input != nullptr) static_cast<void>(entries_of(*input, name));
  Fields fields(mode_, name, input, input != nullptr ? input->location : location_);
  fields.former_keys_ = former_keys_;
  fields.reference_ = reference_;
  describe_child(fields);
  fields.finish(describe_child);
  return std::move(fields.output_);
}

void Fields::finish(const Describe& describe_this) {
  if (mode_ != Mode::kRead) return;
  if (input_ != nullptr && !unknown_allowed_)
    for (const Entry& entry : input_->entries)
      if (std::find(keys_.begin(), keys_.end(), entry.key) == keys_.end())
        fail_unknown(entry, describe_this);
  if (!missing_.empty())
    throw InputError(location_.text(), "missing required key '" + missing_.front() + "'");
}

void Fields::fail_unknown(const Entry& entry, const Describe& describe_this) const {
  const std::string where = path_.empty() ? "" : " in '" + path_ + "'";
  const bool no_space =
      entry.value.kind == Node::Kind::kNull && entry.key.find(':') != std::string::npos;
  if (no_space)
    throw InputError(entry.location.text(),
                     "unknown key '" + entry.key + "'" + where + "; a space must follow ':'");
  const std::string other = choice_that_knows(entry.key, describe_this);
  if (other.empty()) fail_former(entry, name_of(entry.key));
  if (other.empty())
    throw InputError(entry.location.text(), "unknown key '" + entry.key + "'" + where + "; " +
                                                suggestion(entry.key, keys_, "keys"));
  throw InputError(entry.location.text(),
                   "key '" + entry.key + "'" + where + " does not apply to " + other);
}

void Fields::fail_former(const Entry& entry, const std::string& name) const {
  // The most exact row: of a key inside an unknown section before one of the section itself.
  for (const Entry& inner : entry.value.entries) fail_former(inner, name + "." + inner.key);
  if (const auto answer = explain_former_key(name, former_keys_))
    throw InputError(entry.location.text(), *answer);
}

std::string Fields::choice_that_knows(const std::string& key, const Describe& describe_this) const {
  for (const Choice& choice : choices_) {
    for (std::size_t i = 0; i < choice.names.size(); ++i) {
      const Choice other{choice.key, choice.names, i};
      Fields probe(Mode::kProbe, path_, input_, location_);
      probe.probed_ = &other;
      describe_this(probe);
      if (std::find(probe.keys_.begin(), probe.keys_.end(), key) == probe.keys_.end()) continue;
      return choice.key + ": " + choice.names[choice.taken] + " (it belongs to " + choice.key +
             ": " + choice.names[i] + ")";
    }
  }
  return {};
}

void Fields::fail(const Node& at, const std::string& name, const std::string& separator,
                  const std::string& problem) const {
  if (mode_ == Mode::kCheck) throw InputError(name, problem);
  throw error_at(at.location, name, separator, problem);
}

}  // namespace saccade::config
