#include "core/config/rule.h"

#include <algorithm>
#include <filesystem>

#include "core/config/convert.h"
#include "core/config/fields.h"
#include "core/config/suggest.h"

namespace saccade::config {
namespace {

std::string shown(double number) { return to_node(number).text; }

std::string length_text(std::size_t least, std::size_t most) {
  if (most == Rule::kAnyLength) return std::to_string(least) + " or more";
  return std::to_string(least) + (most != least ? " to " + std::to_string(most) : "");
}

}  // namespace

Rule& Rule::range(double low, double high) {
  const std::string allowed = shown(low) + " to " + shown(high);
  const auto low_holds = [low](double x) { return x >= low; };
  const auto high_holds = [high](double x) { return x <= high; };
  check_numbers(low_holds, "is below " + shown(low), allowed);
  check_numbers(high_holds, "is above " + shown(high), allowed);
  return note(allowed);
}

Rule& Rule::above(double low) {
  check_numbers([low](double x) { return x > low; }, "is not above " + shown(low), {});
  return note("> " + shown(low));
}

Rule& Rule::at_least(double low) {
  check_numbers([low](double x) { return x >= low; }, "is below " + shown(low), {});
  return note(">= " + shown(low));
}

Rule& Rule::below(double high) {
  check_numbers([high](double x) { return x < high; }, "is not below " + shown(high), {});
  return note("< " + shown(high));
}

Rule& Rule::at_most(double high) {
  check_numbers([high](double x) { return x <= high; }, "is above " + shown(high), {});
  return note("<= " + shown(high));
}

Rule& Rule::length(std::size_t least, std::size_t most) {
  if (node_ != nullptr) check_length(*node_, key_, least, most);
  return note(length_text(least, most) + " values");
}

Rule& Rule::item_length(std::size_t least, std::size_t most) {
  for (std::size_t i = 0; node_ != nullptr && i < node_->items.size(); ++i)
    check_length(node_->items[i], item_name(key_, i), least, most);
  return note(length_text(least, most) + " numbers each");
}

Rule& Rule::one_of(const std::vector<std::string>& names) {
  check_texts([&](const Node& node, const std::string& name) {
    if (std::find(names.begin(), names.end(), node.text) == names.end())
      fields_.fail(node, name, ": ",
                   "unknown value '" + node.text + "'; " + suggestion(node.text, names, "values"));
  });
  return note(joined(names));
}

Rule& Rule::required() {
  fields_.require(key_);
  return note("required");
}

Rule& Rule::must_exist() {
  check_texts([&](const Node& node, const std::string& name) {
    if (node.text.empty()) return;
    std::filesystem::path path;
    from_node(node, name, path);
    const std::string whole = path.string();
    const std::string outer = whole.substr(0, whole.find("!/"));
    std::error_code error;
    if (!std::filesystem::exists(outer, error))
      fields_.fail(node, name, ": ", "no such file '" + outer + "'");
  });
  return *this;
}

template <class Holds>
void Rule::check_numbers(Holds holds, const std::string& broken, const std::string& allowed) const {
  const auto check = [&](const auto& self, const Node& node, const std::string& name) -> void {
    for (std::size_t i = 0; i < node.items.size(); ++i)
      self(self, node.items[i], item_name(name, i));
    const auto number = number_of(node);
    if (!number || holds(*number)) return;
    const std::string range = allowed.empty() ? "" : " (allowed: " + allowed + ")";
    fields_.fail(node, name, " = ", node.text + " " + broken + range);
  };
  if (node_ != nullptr) check(check, *node_, key_);
}

template <class Check>
void Rule::check_texts(Check check) const {
  if (node_ == nullptr) return;
  if (node_->kind == Node::Kind::kScalar) check(*node_, key_);
  for (std::size_t i = 0; i < node_->items.size(); ++i)
    if (node_->items[i].kind == Node::Kind::kScalar) check(node_->items[i], item_name(key_, i));
}

void Rule::check_length(const Node& list, const std::string& name, std::size_t least,
                        std::size_t most) const {
  const std::size_t size = list.items.size();
  if (list.kind != Node::Kind::kList || (size >= least && size <= most)) return;
  fields_.fail(
      list, name, ": ",
      "expected a list of " + length_text(least, most) + " values, got " + std::to_string(size));
}

Rule& Rule::note(const std::string& text) {
  fields_.note(key_, text);
  return *this;
}

}  // namespace saccade::config
