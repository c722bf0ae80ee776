#include "core/config/reference.h"

#include <algorithm>
#include <iterator>
#include <string_view>
#include <utility>

#include "core/config/fields.h"

namespace saccade::config {
namespace {

using Keys = std::vector<ReferenceKey>;

/// Choices of a key's form are named "gamma?".
constexpr char kFormMark = '?';

bool is_within(std::string_view name, std::string_view section) {
  return name.starts_with(section) && (name.size() == section.size() ||
                                       name[section.size()] == '.' || name[section.size()] == '[');
}

template <class List>
auto find_key(List& keys, const std::string& name) {
  return std::find_if(keys.begin(), keys.end(), [&](const auto& key) { return key.name == name; });
}

template <class List>
bool holds_key(const List& keys, const std::string& name) {
  return find_key(keys, name) != keys.end();
}

/// "`method: rays` or `sweep`", "`views`", "no `views`".
std::string condition_text(const ReferenceRecord::Choice& choice,
                           const std::vector<std::size_t>& values) {
  if (choice.name.back() == kFormMark) {
    const std::string key = "`" + choice.name.substr(0, choice.name.size() - 1) + "`";
    return values.front() == 0 ? "no " + key : key;
  }
  std::string text;
  for (const std::size_t value : values)
    text += (text.empty() ? "`" + choice.name + ": " : " or `") + choice.values[value] + "`";
  return text;
}

class Explorer {
 public:
  explicit Explorer(const std::function<void(ReferenceRecord&)>& describe) : describe_(describe) {}

  Keys explore() {
    const ReferenceRecord base = described({});
    keys_ = base.keys;
    for (const ReferenceRecord::Choice& choice : base.choices) conditions_[choice.name] = {};
    explore_choices(base);
    return std::move(keys_);
  }

 private:
  using Held = std::map<std::string, std::size_t>;

  ReferenceRecord described(const Held& held) {
    ReferenceRecord record;
    record.held = held;
    describe_(record);
    of_any_form_.insert(record.of_any_form.begin(), record.of_any_form.end());
    return record;
  }

  /// Tries the choices of `base` that no run before has shown.
  void explore_choices(const ReferenceRecord& base) {
    std::vector<ReferenceRecord::Choice> choices;
    for (const ReferenceRecord::Choice& choice : base.choices)
      if (explored_.insert(choice.name).second) choices.push_back(choice);
    for (const ReferenceRecord::Choice& choice : choices) {
      std::vector<ReferenceRecord> runs;
      for (std::size_t value = 0; value < choice.values.size(); ++value) {
        Held held = base.held;
        held[choice.name] = value;
        runs.push_back(described(held));
      }
      const Keys before = keys_;
      for (const ReferenceRecord& run : runs) add_new(run.keys, conditions_[choice.name]);
      add_conditions(choice, runs, base.keys, before);
      add_other_initials(choice, runs, base.keys);
      find_choices(choice, runs);
      for (const ReferenceRecord& run : runs) explore_choices(run);
    }
  }

  /// The conditions of the choices that only some values of `choice` lead to.
  void find_choices(const ReferenceRecord::Choice& choice,
                    const std::vector<ReferenceRecord>& runs) {
    for (const ReferenceRecord& run : runs) {
      for (const ReferenceRecord::Choice& found : run.choices) {
        if (conditions_.contains(found.name)) continue;
        std::vector<std::size_t> values;
        for (std::size_t value = 0; value < runs.size(); ++value)
          if (holds_key(runs[value].choices, found.name)) values.push_back(value);
        std::vector<std::string> conditions = conditions_[choice.name];
        if (choice.name.back() != kFormMark) conditions.push_back(condition_text(choice, values));
        conditions_[found.name] = std::move(conditions);
      }
    }
  }

  /// New keys stand before the next one that is known.
  void add_new(const Keys& found, const std::vector<std::string>& conditions) {
    Keys added;
    for (const ReferenceKey& key : found) {
      const auto known = find_key(keys_, key.name);
      if (known == keys_.end()) {
        added.push_back(key);
        added.back().conditions = conditions;
        continue;
      }
      if (known->type.find(key.type) == std::string::npos) known->type += " or " + key.type;
      keys_.insert(known, added.begin(), added.end());
      added.clear();
    }
    keys_.insert(keys_.end(), added.begin(), added.end());
  }

  /// A key that some values of the choice know and others do not gets this as a condition; as an
  /// alternative where another choice has led to it `before`.
  void add_conditions(const ReferenceRecord::Choice& choice,
                      const std::vector<ReferenceRecord>& runs, const Keys& base,
                      const Keys& before) {
    for (ReferenceKey& key : keys_) {
      std::vector<std::size_t> values;
      for (std::size_t value = 0; value < runs.size(); ++value)
        if (holds_key(runs[value].keys, key.name)) values.push_back(value);
      if (values.empty() || values.size() == runs.size() || takes_any_form(key.name)) continue;
      const std::string condition = condition_text(choice, values);
      if (!holds_key(before, key.name) || holds_key(base, key.name)) {
        key.conditions.push_back(condition);
      } else if (!key.conditions.empty()) {
        key.conditions.back() += " or " + condition;
      }
    }
  }

  /// The defaults of the keys of `base` that a value of the choice changes.
  void add_other_initials(const ReferenceRecord::Choice& choice,
                          const std::vector<ReferenceRecord>& runs, const Keys& base) {
    if (choice.name.back() == kFormMark) return;
    for (const ReferenceKey& usual : base) {
      if (usual.name == choice.name) continue;
      const auto key = find_key(keys_, usual.name);
      for (std::size_t value = 0; value < runs.size(); ++value) {
        const auto other = find_key(runs[value].keys, usual.name);
        if (other == runs[value].keys.end() || other->initial == usual.initial) continue;
        key->other_initials.push_back("`" + other->initial + "` with " +
                                      condition_text(choice, {value}));
      }
    }
  }

  /// Whether the key is valid wherever it is stated, whatever the choices say.
  [[nodiscard]] bool takes_any_form(const std::string& name) const {
    return std::any_of(of_any_form_.begin(), of_any_form_.end(),
                       [&](const std::string& key) { return is_within(name, key); });
  }

  const std::function<void(ReferenceRecord&)>& describe_;
  Keys keys_;
  std::set<std::string> explored_;
  std::map<std::string, std::vector<std::string>> conditions_;  ///< of each choice
  std::set<std::string> of_any_form_;
};

std::string section_of(const std::string& name) {
  const std::size_t dot = name.rfind('.');
  return dot == std::string::npos ? "" : name.substr(0, dot);
}

/// The conditions that do not hold for the whole section already.
std::string own_conditions(const ReferenceKey& key, const ReferenceKey* section) {
  std::string text;
  for (const std::string& condition : key.conditions) {
    const bool inherited = section != nullptr && std::count(section->conditions.begin(),
                                                            section->conditions.end(), condition);
    if (!inherited) text += (text.empty() ? "" : " and ") + condition;
  }
  return text.empty() ? "" : "Only with " + text + ".";
}

std::string cell(const std::string& text) {
  std::string escaped;
  for (const char c : text) escaped += c == '|' ? "\\|" : std::string(1, c);
  return escaped;
}

std::string code(const std::string& text) { return text.empty() ? "" : "`" + cell(text) + "`"; }

std::string initials(const ReferenceKey& key) {
  std::string text = code(key.initial);
  for (const std::string& other : key.other_initials)
    text += (text.empty() ? "" : "; ") + cell(other);
  return text;
}

std::string row(const ReferenceKey& key, const ReferenceKey* section) {
  const std::string condition = own_conditions(key, section);
  const std::string own_name =
      key.name.substr(section_of(key.name).empty() ? 0 : section_of(key.name).size() + 1);
  return "| " + code(own_name) + " | " + key.type + " | " + initials(key) + " | " + cell(key.rule) +
         " | " + cell(key.help) + (condition.empty() ? "" : " ") + condition + " |\n";
}

}  // namespace

std::size_t ReferenceRecord::take(const std::string& name, const std::vector<std::string>& values,
                                  std::size_t current) {
  if (find_key(choices, name) == choices.end()) choices.push_back({name, values});
  const auto found = held.find(name);
  return found == held.end() ? current : found->second;
}

Form ReferenceRecord::form(const std::string& name) {
  of_any_form.insert(name);
  if (held.contains(name)) return Form::kText;
  return static_cast<Form>(take(name + kFormMark, {"absent", "number", "text", "list", "map"}, 0));
}

void ReferenceRecord::add_rule(const std::string& name, const std::string& rule) {
  const auto key = find_key(keys, name);
  if (key != keys.end()) key->rule += (key->rule.empty() ? "" : ", ") + rule;
}

std::vector<ReferenceKey> explore_keys(const std::function<void(ReferenceRecord&)>& describe) {
  return Explorer(describe).explore();
}

std::string to_markdown(const std::vector<ReferenceKey>& keys) {
  constexpr std::string_view kHeader =
      "\n| key | type | default | allowed | meaning |\n|---|---|---|---|---|\n";
  std::string text(kHeader);
  const auto is_section = [](const ReferenceKey& key) {
    return key.type.find("section") != std::string::npos;
  };
  for (const ReferenceKey& key : keys)
    if (section_of(key.name).empty()) text += row(key, nullptr);
  for (const ReferenceKey& section : keys) {
    if (!is_section(section)) continue;
    const bool is_list = section.type.find("list of sections") != std::string::npos;
    const std::string name = section.name + (is_list ? "[]" : "");
    const std::string condition = own_conditions(section, nullptr);
    text += "\n## `" + name + "`\n\n" + section.help + (condition.empty() ? "" : " ") + condition +
            "\n" + std::string(kHeader);
    for (const ReferenceKey& key : keys)
      if (section_of(key.name) == name) text += row(key, &section);
  }
  return text;
}

}  // namespace saccade::config
